// pipeline/ingest/show_living.h -- the living grid of a volume that goes on growing.
//
// Inside the pipeline room only. Thread contract: for different volumes by many threads.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/ingest_context.h"

namespace stormcellar::pipeline {

// Grids the sweeps that have closed, with what stands of the site's last volume, and adds the grid
// to the outcome's `living`. `file`: what the grid's provenance is to say of the raw file. False:
// the news have still to be shown, as there is no time for that now, or no grid can be made yet.
// Errors: those of the cache and the system.
[[nodiscard]] Result<bool> show_living(IngestContext& context, const ShelvedVolume& kept,
                                       UnshownSweeps news, const std::string& file,
                                       std::int64_t modified_ns, IngestOutcome& outcome);

}  // namespace stormcellar::pipeline

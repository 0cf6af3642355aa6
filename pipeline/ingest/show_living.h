// pipeline/ingest/show_living.h -- makes the living grids of a growing volume.
//
// Inside the pipeline room only. Thread contract: many threads may call it for different volumes.
#pragma once

#include <string>

#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/ingest_context.h"

namespace stormcellar::pipeline {

// Makes a grid for each moment with new data. The grid shows the complete sweeps, and the sweeps of
// the site's last volume that no complete sweep has replaced yet. Adds the grids to the outcome's
// `living`. `file` is the name of the raw file. Returns false if the new sweeps must be shown
// later, because there is no time now or no grid can be made yet. Errors: those of the cache and
// the system.
[[nodiscard]] Result<bool> show_living(IngestContext& context, const ShelvedVolume& kept,
                                       UnshownSweeps news, const std::string& file,
                                       IngestOutcome& outcome);

}  // namespace stormcellar::pipeline

// pipeline/care/archive_frames.h -- makes the frames of a domain from the partials in a cache.
//
// Each frame is made once, from the partials (grids of single sites) around it
// (pipeline/mosaic/mosaic_maker.h). Workers make several frames at a time, one frame each, because
// several threads at one frame would wait for each other more. The bytes of a frame do not depend
// on who makes it or when.
//
// Memory    Each worker keeps geometries and instants of its own: some 400 MiB for a large domain.
// Threads   One thread at a time for each domain and moment of a store. `progress` is called from
//           the workers, one at a time.
// Errors    Those of the store and of making a frame.
#pragma once

#include <atomic>
#include <vector>

#include "pipeline/care/archive_fill.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// Makes the frames at `instants` that are due and are missing or outdated. Adds to the report how
// many frames were made and how many found, their instants, and what the new frames leave out. Once
// `stop` is set, begins no further frame.
[[nodiscard]] Status make_frames(cache::StoreWriter& store, const Domain& domain,
                                 level2::Moment moment, const std::vector<UtcTime>& instants,
                                 int threads, const FillProgress& progress,
                                 const std::atomic<bool>& stop, FillReport& report);

}  // namespace stormcellar::pipeline

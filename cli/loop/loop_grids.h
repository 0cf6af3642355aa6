// cli/loop/loop_grids.h -- finds the grids for a loop, in a cache or from an archive.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cli/loop/archive_loop.h"
#include "cli/loop/loop_options.h"
#include "cli/shared/interrupt.h"
#include "pipeline/mosaic/between_grids.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// A frame of the loop. Its grid exists, or is made when the frame is drawn.
struct LoopFrame {
    UtcTime time;
    std::optional<cache::StoreEntry> stored;
};

struct LoopGrids {
    std::optional<cache::StoreReader> store;
    std::string domain;
    TimeRange range;
    std::vector<LoopFrame> frames;  // ascending in time; empty: nothing matched, which has been
                                    // reported
    std::size_t frames_there = 0;   // number of frames before the frames that go back
    std::filesystem::path sample;   // an existing grid
    std::optional<pipeline::BetweenGrids> between;  // makes grids of frames that do not exist
    std::optional<ArchiveCall> call;                // set if the grids come from an archive
    std::optional<ArchiveGrids> archive;
};

// Returns a frame for each of these grids of a cache.
[[nodiscard]] LoopGrids grids_of(const cache::StoreReader& store, const std::string& domain,
                                 const std::vector<cache::StoreEntry>& entries);
// Returns the requested grids that a cache has now. Relative times such as "1h ago" count from the
// call.
[[nodiscard]] Result<std::vector<cache::StoreEntry>> entries_now(const cache::StoreReader& store,
                                                                 const LoopOptions& options,
                                                                 level2::Moment moment);

// Finds the grids. Errors: bad_argument, naming options that are missing or cannot be combined;
// those of the cache, the catalog and of filling.
[[nodiscard]] Result<LoopGrids> find_grids(const LoopOptions& options, const render::Scene& scene,
                                           Interrupt& interrupt);

}  // namespace stormcellar::cli

// cli/loop/loop_grids.h -- which grids a loop is drawn from: those of a cache, or made of an
// archive.
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

// One frame: a grid that stands, or one that is made when the frame is drawn.
struct LoopFrame {
    UtcTime time;
    std::optional<cache::StoreEntry> stored;
};

struct LoopGrids {
    std::optional<cache::StoreReader> store;
    std::string domain;
    TimeRange range;
    std::vector<LoopFrame> frames;  // rising in time; empty: nothing matched, which was said
    std::filesystem::path sample;   // a grid that stands
    std::optional<pipeline::BetweenGrids> between;  // makes the frames that do not stand
    std::optional<ArchiveCall> call;                // of an archive, and what became of it
    std::optional<ArchiveGrids> archive;
};

// Of a cache's grids as they are.
[[nodiscard]] LoopGrids grids_of(const cache::StoreReader& store, const std::string& domain,
                                 const std::vector<cache::StoreEntry>& entries);
// The grids of a cache that are asked for, as of now: relative times count from the call.
[[nodiscard]] Result<std::vector<cache::StoreEntry>> entries_now(const cache::StoreReader& store,
                                                                 const LoopOptions& options,
                                                                 level2::Moment moment);

// Errors: bad_argument, naming options that are missing or go ill together; those of the cache, the
// catalog and of filling.
[[nodiscard]] Result<LoopGrids> find_grids(const LoopOptions& options, const render::Scene& scene,
                                           Interrupt& interrupt);

}  // namespace stormcellar::cli

// cli/loop_grids.h -- which grids a loop is drawn from: those of a cache, or made of an archive.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "cache/store.h"
#include "cli/archive_loop.h"
#include "cli/interrupt.h"
#include "cli/loop_options.h"
#include "render/scene.h"

namespace stormcellar::cli {

struct LoopGrids {
    std::optional<cache::Store> store;
    std::string domain;
    TimeRange range;
    std::vector<cache::StoreEntry>
        entries;                      // rising in time; empty: nothing matched, which was said
    std::optional<ArchiveCall> call;  // of an archive, and what became of it
    std::optional<ArchiveGrids> archive;
};

// Errors: bad_argument, naming options that are missing or go ill together; those of the cache, the
// catalog and of filling.
[[nodiscard]] Result<LoopGrids> find_grids(const LoopOptions& options, const render::Scene& scene,
                                           Interrupt& interrupt);

}  // namespace stormcellar::cli

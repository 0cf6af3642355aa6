// cli/loop/archive_loop.h -- makes the grids that a loop of an archive needs and the cache lacks
// (pipeline/care/archive_fill.h).
//
// The grids are kept in the cache of --cache. Without --cache they are kept in a private cache
// below $XDG_CACHE_HOME (else ~/.cache). The name of its directory has a hash of everything that
// determines the grids: catalog, stations, grid, moment, rules, version. Only one process at a time
// can fill a cache.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/loop/archive_options.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/query_options.h"
#include "pipeline/care/archive_fill.h"
#include "pipeline/care/archive_plan.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

// An archive request, with the related options of the command.
struct ArchiveCall {
    ArchiveRequest request;
    std::filesystem::path catalog;
    std::set<std::filesystem::path> files;  // files of the catalog to use; empty: all
    std::filesystem::path cache;            // empty: a private cache
    std::string domain;                     // of a mosaic; empty: named after its stations
    TimeRange range;                        // both ends are required
    level2::Moment moment = level2::Moment::ref;
    retrieve::DerivedOptions derived;
    std::optional<std::chrono::seconds> interval;
    grid::TimeMethod time = grid::TimeMethod::advected;
    int threads = 1;
    bool keep = true;
    bool quiet = false;
};

struct ArchiveGrids {
    std::optional<cache::RollingStore> store;  // locks the cache against other writers
    std::string domain;
    std::vector<cache::StoreEntry> entries;  // entries in the range, ascending in time
    std::optional<pipeline::Domain> mosaic;  // none: the station's own grids
    pipeline::FillReport report;
    double fill_s = 0, frames_s = 0;
    std::filesystem::path directory;  // of the cache
    std::uint64_t bytes = 0;          // size of the cache; leave_cache() sets it
};

// Fills the cache, with progress on stderr. Prints to stderr which files it leaves out. If nothing
// in the catalog matches, returns none and says why in `nothing`. An interrupt ends the process at
// once; grids that were committed stay.
[[nodiscard]] Result<std::optional<ArchiveGrids>> fill_from_archive(const ArchiveCall& call,
                                                                    Interrupt& interrupt,
                                                                    std::string& nothing);

// Prints the path and the size of the cache. Removes a private cache unless it must be kept.
[[nodiscard]] Status leave_cache(const ArchiveCall& call, ArchiveGrids& grids);

}  // namespace stormcellar::cli

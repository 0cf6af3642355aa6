// pipeline/care/archive_plan.h -- decides which grids to make from the raw files of an archive, and
// where to keep them (pipeline/care/archive_fill.h makes them).
//
// Thread contract: each call works alone.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/care/archive_fill.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {

struct ArchivePlan {
    std::vector<std::string> stations;
    std::optional<Domain> mosaic;  // none: the station's own grid
    ArchiveOptions fill;
    std::filesystem::path cache;
    std::vector<LeftOut> left_out;  // stations without a known position
};

// Returns the positions of the stations, from their files or the station table. Adds each station
// without a position to `left_out`, with the reason.
[[nodiscard]] std::vector<grid::SitePosition> sites_of(const catalog::CatalogReader& catalog,
                                                       const std::vector<std::string>& stations,
                                                       std::vector<LeftOut>& left_out);

// Returns the directory of all private caches: $XDG_CACHE_HOME/stormcellar/loops, or else the same
// below ~/.cache. Errors: bad_argument if the environment names neither.
[[nodiscard]] Result<std::filesystem::path> loops_directory();

// Returns a directory below $XDG_CACHE_HOME, or else below ~/.cache. Its name contains a hash of
// everything that determines the plan's grids: catalog, stations, grid, moment, rules and the
// version of this software. Errors: bad_argument if the environment names no such place.
[[nodiscard]] Result<std::filesystem::path> private_cache(const std::filesystem::path& catalog,
                                                          level2::Moment moment,
                                                          const ArchivePlan& plan);

// Checks that grids in this directory would not be mixed with other files, least of all with a drop
// directory. A cache holds directories of domains, and these hold directories of moments. Errors:
// bad_argument for a directory that holds anything else. A directory that does not exist is fine.
[[nodiscard]] Status check_cache_directory(const std::filesystem::path& directory);

// Returns the grids of the cache at these times. Errors: those of StoreReader::list().
[[nodiscard]] Result<std::vector<cache::StoreEntry>> entries_at(const cache::StoreReader& store,
                                                                const std::string& domain,
                                                                level2::Moment moment,
                                                                const std::set<UtcTime>& times);

}  // namespace stormcellar::pipeline

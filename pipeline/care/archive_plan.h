// pipeline/care/archive_plan.h -- describes which grids to make from the raw files of an archive,
// and where to keep them. pipeline/care/archive_fill.h makes them.
//
// Thread contract: functions without state; they read the catalog and directories.
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
    std::optional<Domain> mosaic;  // none: a station's own grids
    ArchiveOptions fill;
    std::filesystem::path cache;
    std::vector<LeftOut> left_out;  // stations without a known position
};

// Returns the positions of the stations (place_of_station()). Adds stations without a position to
// `left_out`, with the reason. Skips empty names.
[[nodiscard]] std::vector<grid::SitePosition> sites_of(const catalog::CatalogReader& catalog,
                                                       const std::vector<std::string>& stations,
                                                       std::vector<LeftOut>& left_out);

// Returns the directory of all private caches: $XDG_CACHE_HOME/stormcellar/loops, or
// ~/.cache/stormcellar/loops if XDG_CACHE_HOME is not an absolute path. Errors: bad_argument if
// HOME is not an absolute path, either.
[[nodiscard]] Result<std::filesystem::path> loops_directory();

// Returns a directory in loops_directory() for the plan's grids. The directory's name contains a
// hash of everything that determines the grids: catalog, stations, grid, moment, the derivation of
// the moment, rules and the version of this software. A plan without a mosaic must have a station.
// Errors: those of loops_directory().
[[nodiscard]] Result<std::filesystem::path> private_cache(const std::filesystem::path& catalog,
                                                          level2::Moment moment,
                                                          const ArchivePlan& plan);

// Checks that grids in this directory would not get mixed with other files, for example with the
// files of a drop directory. A cache holds only directories of domains, and these hold only
// directories of moments. Names that begin with '.' are ignored. Errors: bad_argument if the
// directory holds anything else. A directory that does not exist or cannot be read passes the
// check.
[[nodiscard]] Status check_cache_directory(const std::filesystem::path& directory);

// Returns the grids that the cache has at these times. Errors: those of StoreReader::list().
[[nodiscard]] Result<std::vector<cache::StoreEntry>> entries_at(const cache::StoreReader& store,
                                                                const std::string& domain,
                                                                level2::Moment moment,
                                                                const std::set<UtcTime>& times);

}  // namespace stormcellar::pipeline

// pipeline/care/rebuild_catalog.h -- makes the catalog again from the files that exist.
//
// Damaged databases are set aside and repaired, which keeps the rows of files that are gone
// (stormcellar/catalog/repair.h). Then every file below the drop directory is decoded and
// registered, if it has changed since it was cataloged or was never cataloged. Rows of files that
// do not exist become `gone`. Sound databases keep their rows, so rebuilding a sound catalog
// changes nothing. No grids are made. Nothing else may write the catalog meanwhile, so hold the
// lock of the state directory (instance_lock.h).
//
// Threads   A function without state. `progress` is called from the calling thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/catalog/repair.h"

namespace stormcellar::pipeline {

struct RebuildOptions {
    std::filesystem::path catalog;
    std::filesystem::path drop;  // symbolic links below it are not followed
    // The files below `drop` to examine, as absolute paths in which links are resolved. Empty: all
    // files below `drop`.
    std::vector<std::filesystem::path> files;
    // If set, only the database of this station is repaired, and only files that may be this
    // station's are examined. Empty: all stations.
    std::string station;
    std::shared_ptr<StationRule> stations;  // stations that may have a database; null: every ICAO
    int threads = 1;                        // for decoding
    std::function<void(std::size_t done, std::size_t all)> progress;
};

struct RebuildReport {
    std::vector<catalog::Repair> repairs;
    std::size_t files = 0;       // files examined
    std::size_t unchanged = 0;   // files that have not changed since they were cataloged
    std::size_t registered = 0;  // files decoded, in whole or in part
    std::size_t rejected = 0;    // files registered as not decodable
    int gone = 0;                // rows whose files no longer exist
    // Files and directories that could not be read, and databases that could not be used.
    std::vector<Error> problems;
};

// Rebuilds the catalog, and records the drop directory in it. Errors: the catalog's directory, or
// the database of the only requested station, cannot be used; the disk is full; or the drop
// directory cannot be read. Work done before an error stays, and a second call continues from
// there.
[[nodiscard]] Result<RebuildReport> rebuild_catalog(const RebuildOptions& options);

}  // namespace stormcellar::pipeline

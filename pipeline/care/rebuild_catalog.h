// pipeline/care/rebuild_catalog.h -- makes the catalog again from the files.
//
// Damaged databases are set aside and mended (stormcellar/catalog/repair.h; rows of files that are
// gone stay). Then every file below the drop directory that differs from its row in the catalog, or
// has no row, is decoded and registered, and rows of files that are no longer there become gone.
// Sound databases keep their rows, so rebuilding a sound catalog changes nothing. Nothing is
// gridded. Nobody else may write the catalog meanwhile: hold the lock of the state directory
// (instance_lock.h). Thread contract: a function; it calls `progress` from the calling thread.
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
    std::string station;         // only its database, and the files that may be its own; empty: all
    std::shared_ptr<StationRule> stations;  // the stations that have a database; none: every ICAO
    int threads = 1;                        // for decoding
    std::function<void(std::size_t done, std::size_t all)> progress;
};

struct RebuildReport {
    std::vector<catalog::Repair> repairs;
    std::size_t files = 0;       // examined
    std::size_t unchanged = 0;   // of these, the files whose rows were right
    std::size_t registered = 0;  // decoded, completely or in part
    std::size_t rejected = 0;    // not decodable, registered as such
    int gone = 0;                // rows of files that are no longer there
    // Files and directories that could not be read, and databases that could not be used.
    std::vector<Error> problems;
};

// Fails if the directory of the catalog cannot be used, the disk is full or the drop directory
// cannot be read. What was done until then stays, and a second call continues from there. It also
// tells the catalog its drop directory.
[[nodiscard]] Result<RebuildReport> rebuild_catalog(const RebuildOptions& options);

}  // namespace stormcellar::pipeline

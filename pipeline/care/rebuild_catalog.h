// pipeline/care/rebuild_catalog.h -- makes the catalog again from the files that exist.
//
// Damaged databases are set aside and repaired (stormcellar/catalog/repair.h; rows of files that
// are gone stay). Then every file below the drop directory that the catalog does not have in its
// present state is decoded and registered, and rows of files that do not exist become gone. Sound
// databases keep their rows, so rebuilding a sound catalog changes nothing. Nothing is gridded.
// Nothing else may write the catalog meanwhile: hold the lock of the state directory
// (instance_lock.h).
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
    // Only these files are examined, wherever below `drop` they are: absolute paths without links.
    // Empty: all files below it.
    std::vector<std::filesystem::path> files;
    // only this station's database, and files that may belong to it; empty: all
    std::string station;
    std::shared_ptr<StationRule> stations;  // stations that have a database; null: every ICAO
    int threads = 1;                        // for decoding
    std::function<void(std::size_t done, std::size_t all)> progress;
};

struct RebuildReport {
    std::vector<catalog::Repair> repairs;
    std::size_t files = 0;       // files examined
    std::size_t unchanged = 0;   // files that the catalog has in their present state
    std::size_t registered = 0;  // decoded, whole or in part
    std::size_t rejected = 0;    // not decodable, and registered as such
    int gone = 0;                // rows of files that no longer exist
    // Files and directories that could not be read, and databases that could not be used.
    std::vector<Error> problems;
};

// Rebuilds the catalog, and records the drop directory in it. Errors: the catalog's directory
// cannot be used, the disk is full, or the drop directory cannot be read. Work done until then
// stays, and a second call continues from there.
[[nodiscard]] Result<RebuildReport> rebuild_catalog(const RebuildOptions& options);

}  // namespace stormcellar::pipeline

// pipeline/care/rebuild_catalog.h -- the catalog made again from what there is.
//
// Damaged databases are set aside and mended (stormcellar/catalog/repair.h: rows of files that are
// gone stay); then every file below the drop directory that the catalog does not have as it now
// stands is decoded and registered, and rows of files that are not there become gone. Sound
// databases keep their rows, so a rebuild of a sound catalog changes nothing. Nothing is gridded.
// Nothing else may write the catalog meanwhile: hold the state directory's lock (instance_lock.h).
// Thread contract: a function; `progress` is called from the calling thread.
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
    std::string station;         // only this one's database, and files that may be its; empty: all
    std::shared_ptr<StationRule> stations;  // which have a database; none: every ICAO
    int threads = 1;                        // that decode
    std::function<void(std::size_t done, std::size_t all)> progress;
};

struct RebuildReport {
    std::vector<catalog::Repair> repairs;
    std::size_t files = 0;       // looked at
    std::size_t unchanged = 0;   // of these: stood in the catalog as they are
    std::size_t registered = 0;  // decoded, whole or in part
    std::size_t rejected = 0;    // not decodable, registered as such
    int gone = 0;                // rows of files that are not there any more
    // Files and directories that could not be read, and databases that could not be used.
    std::vector<Error> problems;
};

// An error where the catalog's directory cannot be used, the disk is full or the drop directory
// cannot be read; what was done until then stays, and a second call goes on from there. The catalog
// is told the drop directory.
[[nodiscard]] Result<RebuildReport> rebuild_catalog(const RebuildOptions& options);

}  // namespace stormcellar::pipeline

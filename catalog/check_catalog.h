// catalog/check_catalog.h -- checks whether the catalog is sound, and whether it agrees with the
// disk.
//
// It never writes. Rows are compared with the files by size and modification time; the content of
// files is not read. While a daemon writes, a file may be reported as changed that the daemon is
// just taking in.
//
// Threads   Functions without state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {

struct StationCheck {
    std::string station;  // empty: the database of files without a station
    std::filesystem::path database;
    bool is_known = true;             // the rule knows the station
    std::vector<std::string> damage;  // one line each; empty: the database is sound
    std::int64_t files = 0;           // rows
    std::int64_t gone = 0;            // rows that say that their file is gone
    // files that are missing, although their rows do not say gone
    std::vector<std::filesystem::path> missing;
    std::vector<std::filesystem::path> unseen;  // files that could not be looked at
    // with another size or time than when they were settled
    std::vector<std::filesystem::path> changed;
};

struct CatalogCheck {
    std::vector<StationCheck> stations;            // sorted by name
    std::vector<std::filesystem::path> set_aside;  // damaged databases from earlier repairs
    std::vector<Trouble> troubles;                 // databases that could not be opened
    // All was seen, and nothing is damaged, missing or changed.
    [[nodiscard]] bool is_sound() const;
};

// Checks one station, or all if none is named. Databases are opened one after the other, so that
// few descriptors are used. Without a rule every station is known. Errors: not_found if there is no
// such directory or station.
[[nodiscard]] Result<CatalogCheck> check_catalog(const std::filesystem::path& directory,
                                                 std::string_view station,
                                                 const StationRule* stations = nullptr);

struct ClearedDatabase {
    std::string station;
    std::int64_t files = 0;  // rows
    std::int64_t there = 0;  // rows of files that exist
};

struct ClearReport {
    std::vector<ClearedDatabase> cleared;
    std::vector<Trouble> kept;  // could not be read or removed, or hold something that is not ours
};

// Removes the databases of stations that the rule does not know, with their -wal and -shm. Rows of
// existing files are lost with them, and are made again among those of no known station when the
// files are read again (a daemon does that when it starts, rebuild_catalog() when it is called).
// Rows of files that are gone are lost for good, because what an invented station once sent is no
// history. A database that is damaged, or belongs to another program, is kept. Nothing else may use
// the catalog meanwhile. Errors: those of the directory.
[[nodiscard]] Result<ClearReport> clear_unknown(const std::filesystem::path& directory,
                                                const StationRule& stations);

}  // namespace stormcellar::catalog

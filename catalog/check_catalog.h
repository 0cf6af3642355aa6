// catalog/check_catalog.h -- checks whether the catalog is sound and agrees with the disk.
//
// It never writes. It compares rows with files by size and modification time; it does not read the
// contents of files. While a daemon writes, a file may look changed because the daemon is just
// ingesting it. Thread contract: functions without state.
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
    std::string station;  // empty: the database of files without one
    std::filesystem::path database;
    bool is_known = true;                        // the station, by the rule
    std::vector<std::string> damage;             // one line each; empty: the database is sound
    std::int64_t files = 0;                      // rows
    std::int64_t gone = 0;                       // of these, rows that say that their file is gone
    std::vector<std::filesystem::path> missing;  // not there, although the row does not say gone
    std::vector<std::filesystem::path>
        changed;  // size or time differ from when the file was settled
};

struct CatalogCheck {
    std::vector<StationCheck> stations;            // sorted by name
    std::vector<std::filesystem::path> set_aside;  // damaged databases that were set aside earlier
    std::vector<Trouble> troubles;                 // databases that could not be opened
    [[nodiscard]] bool is_sound() const;           // nothing damaged, missing or changed
};

// Checks one station, or all if none is named; one after the other, so that it takes few
// descriptors. Errors: not_found if there is no such directory or station. Without a rule every
// station is known.
[[nodiscard]] Result<CatalogCheck> check_catalog(const std::filesystem::path& directory,
                                                 std::string_view station,
                                                 const StationRule* stations = nullptr);

struct ClearedDatabase {
    std::string station;
    std::int64_t files = 0;  // rows
    std::int64_t there = 0;  // of these, rows of files that exist
};

struct ClearReport {
    std::vector<ClearedDatabase> cleared;
    std::vector<Trouble> kept;  // databases that could not be read or removed, or are not ours
};

// Removes the databases of stations that the rule does not know, with their -wal and -shm files.
// Rows of existing files are lost with them, and are made again among those of no known station
// when the files are read again (by a daemon when it starts, or by rebuild_catalog()). Rows of
// files that are gone are lost for good: what an invented station once sent is no history. A
// database that is damaged, or belongs to another program, is kept. Nobody else may use the catalog
// meanwhile. Errors: those of the directory.
[[nodiscard]] Result<ClearReport> clear_unknown(const std::filesystem::path& directory,
                                                const StationRule& stations);

}  // namespace stormcellar::catalog

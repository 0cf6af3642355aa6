// catalog/check_catalog.h -- checks that the catalog is sound and agrees with the files.
//
// check_catalog() never writes. It compares rows with files by size and modification time, and does
// not read the contents of files. While a daemon writes, a file that it is ingesting may be
// reported as changed.
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
    std::int64_t gone = 0;            // rows marked as gone
    // Missing files whose rows are not marked as gone. Members of archives are not checked.
    std::vector<std::filesystem::path> missing;
    std::vector<std::filesystem::path> unseen;  // files that could not be examined
    // Settled files whose size or modification time differs from their row.
    std::vector<std::filesystem::path> changed;
};

struct CatalogCheck {
    std::vector<StationCheck> stations;            // sorted by name
    std::vector<std::filesystem::path> set_aside;  // damaged databases from earlier repairs
    std::vector<Trouble> troubles;                 // databases that could not be read
    // Returns true if everything was examined, and nothing is damaged, missing or changed.
    [[nodiscard]] bool is_sound() const;
};

// Checks one station, or all if `station` is empty. Opens databases one after the other, so that
// few descriptors are used. Without a rule, every station counts as known. Errors: not_found if
// there is no such directory or station.
[[nodiscard]] Result<CatalogCheck> check_catalog(const std::filesystem::path& directory,
                                                 std::string_view station,
                                                 const StationRule* stations = nullptr);

struct ClearedDatabase {
    std::string station;
    std::int64_t files = 0;  // rows
    std::int64_t there = 0;  // rows of files that exist, and of all members of archives
};

struct ClearReport {
    std::vector<ClearedDatabase> cleared;
    std::vector<Trouble> kept;  // databases that could not be read or removed, or are not this
                                // software's
};

// Removes the databases of stations that the rule does not know, with their -wal and -shm. When
// existing files are read again (by a daemon at its start, or by rebuild_catalog()), their rows are
// made again among the files of unknown stations. Rows of files that are gone are lost for good,
// because data of an invented station have no historical value. A database that is damaged, or
// belongs to another program, is kept. After a removal, settled archives count as changed. Nothing
// else may use the catalog meanwhile. Errors: those of the directory, and of the databases that are
// not to be removed. A database that should be removed but cannot be removed is in `kept`.
[[nodiscard]] Result<ClearReport> clear_unknown(const std::filesystem::path& directory,
                                                const StationRule& stations);

}  // namespace stormcellar::catalog

// catalog/check_catalog.h -- is the catalog sound, and does it say what is on disk?
//
// Never writes. Rows are compared with the files by size and modification time; what is in the
// files is not read. While a daemon writes, a file may be found changed that it is just taking in.
// Thread contract: a function without state.
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
    std::int64_t gone = 0;                       // of these: say that their file is gone
    std::vector<std::filesystem::path> missing;  // not there, and the row does not say gone
    std::vector<std::filesystem::path> changed;  // another size or time than when it was settled
};

struct CatalogCheck {
    std::vector<StationCheck> stations;            // sorted by name
    std::vector<std::filesystem::path> set_aside;  // damaged databases of before
    std::vector<Trouble> troubles;                 // databases that could not be opened
    [[nodiscard]] bool is_sound() const;           // nothing damaged, missing or changed
};

// Of one station, or of all where none is named; one after the other, so few descriptors are taken,
// however many there are. not_found when there is no such directory or station. Without a rule
// every station is known.
[[nodiscard]] Result<CatalogCheck> check_catalog(const std::filesystem::path& directory,
                                                 std::string_view station,
                                                 const StationRule* stations = nullptr);

struct ClearedDatabase {
    std::string station;
    std::int64_t files = 0;  // rows
    std::int64_t there = 0;  // of these: of files that are there
};

struct ClearReport {
    std::vector<ClearedDatabase> cleared;
    std::vector<Trouble> kept;  // could not be read or removed, or hold what is not ours
};

// Removes the databases of stations that the rule does not know, with their -wal and -shm. Rows of
// files that are there are lost with them, and made again among those of no known station when the
// files are read again (a daemon does that when it starts, rebuild_catalog() when it is called).
// Rows of files that are gone are lost for good: what an invented station once sent is no history.
// A database that is damaged, or another program's, is kept. Nothing else may use the catalog
// meanwhile. Errors: those of the directory.
[[nodiscard]] Result<ClearReport> clear_unknown(const std::filesystem::path& directory,
                                                const StationRule& stations);

}  // namespace stormcellar::catalog

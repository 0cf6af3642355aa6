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

#include "base/result.h"

namespace stormcellar::catalog {

struct StationCheck {
    std::string station;  // empty: the database of files without one
    std::filesystem::path database;
    std::vector<std::string> damage;             // one line each; empty: the database is sound
    std::int64_t files = 0;                      // rows
    std::vector<std::filesystem::path> missing;  // not there, and the row does not say gone
    std::vector<std::filesystem::path> changed;  // another size or time than when it was settled
};

struct CatalogCheck {
    std::vector<StationCheck> stations;            // sorted by name
    std::vector<std::filesystem::path> set_aside;  // damaged databases of before
    [[nodiscard]] bool is_sound() const;           // nothing damaged, missing or changed
};

// Of one station, or of all where none is named. not_found when there is no such directory or
// station.
[[nodiscard]] Result<CatalogCheck> check_catalog(const std::filesystem::path& directory,
                                                 std::string_view station);

}  // namespace stormcellar::catalog

// catalog/salvage.h -- reads what can still be read of a damaged database; only repair.h uses it.
//
// It reads whatever SQLite can reach: rows before the damage, rows behind it, and one by one the
// rows between. Rows on a damaged page are lost. Gaps in the numbers of rows tell how many file
// rows that were at most (rows that had moved to another station leave gaps, too). Thread contract:
// functions without state; nobody may write the database meanwhile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {

struct SalvagedVolume {
    VolumeFacts facts;
    int generation = 0;
};

// A plausible row of the table `file`.
struct SalvagedFile {
    FileFacts facts;  // without volumes
    UtcTime registered_time;
    std::vector<SalvagedVolume> volumes;  // in file order; without those that could not be read
};

struct Salvage {
    std::vector<SalvagedFile> files;  // in the order in which they were registered
    std::int64_t unread_files = 0;    // at most this many rows were lost
};

// Never fails: from a file that is not a database, it reads nothing.
[[nodiscard]] Salvage salvage(const std::filesystem::path& database);

}  // namespace stormcellar::catalog

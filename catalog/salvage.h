// catalog/salvage.h -- what can still be read of a damaged database; used by repair.h alone.
//
// Reads whatever SQLite can reach: rows before the damage, behind it, and, between the two, one by
// one. What stood on a damaged page is lost; how many file rows that were is counted by the gaps in
// their numbers (rows that had moved to another station leave gaps, too, so it is at most that).
// Thread contract: functions without state; nothing may write the database meanwhile.
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

// A row of the table `file` that makes sense, as it stood there.
struct SalvagedFile {
    FileFacts facts;  // volumes apart
    UtcTime registered_time;
    std::vector<SalvagedVolume> volumes;  // file order; without those that could not be read
};

struct Salvage {
    std::vector<SalvagedFile> files;  // in the order in which they were registered
    std::int64_t unread_files = 0;    // at most so many rows were lost
};

// Never fails: of a file that is no database at all, nothing is read.
[[nodiscard]] Salvage salvage(const std::filesystem::path& database);

}  // namespace stormcellar::catalog

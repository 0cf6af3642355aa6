// catalog/salvage.h -- reads the readable rows of a damaged database. Used only inside the catalog
// room.
//
// salvage() reads the rows before and after the damage, and tries each row in between. Rows on a
// damaged page are lost. The gaps in the numbers of file rows give an upper bound of the loss,
// because rows that were moved to another station leave gaps, too.
//
// Threads   Functions without state. Nothing may write the database meanwhile.
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

// A plausible row of the table `file`, unchanged.
struct SalvagedFile {
    FileFacts facts;  // without the volumes
    UtcTime registered_time;
    std::vector<SalvagedVolume> volumes;  // in file order, without those that could not be read
};

struct Salvage {
    std::vector<SalvagedFile> files;  // in the order in which they were registered
    std::int64_t unread_files = 0;    // at most this many rows were lost
};

// Reads the rows. Never fails: if the file is not a database, the result has no rows.
[[nodiscard]] Salvage salvage(const std::filesystem::path& database);

}  // namespace stormcellar::catalog

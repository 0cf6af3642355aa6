// stormcellar/catalog/repair.h -- sets a damaged database aside, and makes a new one from the rows
// that can be saved.
//
// KTLX.sqlite is renamed to KTLX.sqlite.damaged-YYYYMMDD_HHMMSS. Its files -wal and -shm are
// renamed in the same way. Nothing reads these files any more, and the operator may delete them.
// The new database has the rows of raw files that are gone (or cannot be examined), because these
// rows could not be made again. Their state is `gone`. Rows of existing files are not taken over,
// because reading the files again gives better rows than a damaged page.
//
// Threads   Nothing else may have the database open, in this process or another.
// Errors    See each function.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::catalog {

struct Repair {
    std::string station;  // empty: the database of files without a station
    std::filesystem::path database;
    std::filesystem::path set_aside;  // empty: the database was deleted or replaced
    std::string damage;               // the findings, in one line
    std::int64_t kept_gone = 0;       // rows of files that are gone, taken over
    std::int64_t to_read_again = 0;   // rows of existing files, not taken over
    std::int64_t lost = 0;            // at most this many rows could not be read
};

// The result of examining a database: the faults (only the first few of a kind), one line each;
// empty if the database is sound. A later version, or a database of another program, is listed as a
// fault, too, although it is not damage.
struct Examination {
    std::vector<std::string> damage;
    bool foreign = false;  // of a later version or another program, so it must not be repaired
};
// Reads the whole database and never writes. Errors: the database cannot be opened or read, for
// another reason than damage.
[[nodiscard]] Result<Examination> examine_database(const std::filesystem::path& path);

// Makes the new database, sets the damaged one aside and puts the new one in its place. Errors: io,
// no_space and permission. After an error or a crash, either the damaged database is still in its
// place, or adopt_mended_database() can complete the repair.
[[nodiscard]] Result<Repair> repair_database(const std::filesystem::path& path,
                                             const std::string& station, const std::string& damage);

// Completes an interrupted repair: if the database is missing, and the complete new database of the
// repair exists, puts the new one in its place. The writer calls this before it opens or creates a
// database.
[[nodiscard]] Status adopt_mended_database(const std::filesystem::path& path);

// Returns a line for logs and people: "PATH: was damaged (...) and is set aside as ...; a new
// database keeps 12 rows of files that are gone, ...".
[[nodiscard]] std::string describe(const Repair& repair);

}  // namespace stormcellar::catalog

// stormcellar/catalog/repair.h -- sets a damaged database aside, and makes a new one from the rows
// that can be saved.
//
// KTLX.sqlite becomes KTLX.sqlite.damaged-YYYYMMDD_HHMMSS, with its -wal and -shm. Nothing reads it
// any more, and the operator may delete it. The new database holds the rows of raw files that are
// gone (or cannot be examined), as `gone`, because these rows could not be made again. Rows of
// existing files are not taken over: reading the file again gives better rows than a damaged page.
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
    std::filesystem::path set_aside;  // empty: it was deleted or replaced, so nothing was there
    std::string damage;               // the findings, in one line
    std::int64_t kept_gone = 0;       // rows of files that are gone, taken over
    std::int64_t to_read_again = 0;   // rows of existing files, not taken over
    std::int64_t lost = 0;            // at most this many rows could not be read
};

// The result of examining a database: every fault, one line each; empty if it is sound. The
// examination reads the whole database and never writes. "Is of a later version" and "is not a
// catalog of this software" are listed too, though they are not damage. Errors: io if it cannot be
// opened at all.
struct Examination {
    std::vector<std::string> damage;
    bool foreign = false;  // of a later version or another program, so it must not be repaired
};
[[nodiscard]] Result<Examination> examine_database(const std::filesystem::path& path);

// Makes the new database, sets the damaged one aside and puts the new one in its place. Errors: io,
// no_space and permission; the damaged database is then still there, or the new one waits to be
// adopted. A crash at any instant leaves one of the two as well.
[[nodiscard]] Result<Repair> repair_database(const std::filesystem::path& path,
                                             const std::string& station, const std::string& damage);

// If there is no database, adopts the new one of a repair that was interrupted at its end. The
// writer calls this before it opens or makes a database.
[[nodiscard]] Status adopt_mended_database(const std::filesystem::path& path);

// Returns a line for logs and people: "KTLX.sqlite: set aside as ...; 12 rows of files that are
// gone kept, ...".
[[nodiscard]] std::string describe(const Repair& repair);

}  // namespace stormcellar::catalog

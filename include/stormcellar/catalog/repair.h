// stormcellar/catalog/repair.h -- a damaged database is set aside, and a new one takes over what it
// can.
//
// KTLX.sqlite becomes KTLX.sqlite.damaged-YYYYMMDD_HHMMSS (its -wal and -shm with it), which
// nothing reads any more and the operator may delete. The new one holds the rows of raw files that
// are gone (or cannot be looked at), as `gone`: these could not be had again. Rows of files that
// are there are not taken over: reading the file again says it better than a damaged page. Thread
// contract: nothing else may have the database open, in this process or another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::catalog {

struct Repair {
    std::string station;  // empty: the database of files without one
    std::filesystem::path database;
    std::filesystem::path set_aside;  // empty: it was deleted or replaced, so nothing was there
    std::string damage;               // what was found, one line
    std::int64_t kept_gone = 0;       // rows of files that are gone, taken over
    std::int64_t to_read_again = 0;   // rows of files that are there, left out
    std::int64_t lost = 0;            // at most so many rows could not be read
};

// Everything that is wrong with a database as such, one line each; empty when it is sound. Reads
// all of it and never writes. Also "is of a later version" and "is not a catalog of this software",
// which is no damage. io where it cannot be opened at all.
struct Examination {
    std::vector<std::string> damage;
    bool foreign = false;  // of a later version or another program: not ours to mend
};
[[nodiscard]] Result<Examination> examine_database(const std::filesystem::path& path);

// Makes the new one, sets the damaged one aside and puts the new one in its place. io, no_space,
// permission: the damaged one is still there, or the new one waits to be adopted. A crash at any
// instant leaves one of the two as well.
[[nodiscard]] Result<Repair> repair_database(const std::filesystem::path& path,
                                             const std::string& station, const std::string& damage);

// Where no database stands, puts the one there that a repair left, which was cut short at its end.
// For the writer, before it opens or makes a database.
[[nodiscard]] Status adopt_mended_database(const std::filesystem::path& path);

// "KTLX.sqlite: set aside as ...; 12 rows of files that are gone kept, ...": for logs and people.
[[nodiscard]] std::string describe(const Repair& repair);

}  // namespace stormcellar::catalog

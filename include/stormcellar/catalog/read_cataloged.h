// stormcellar/catalog/read_cataloged.h -- reads cataloged raw files again.
//
// A path in the catalog names the file that existed there when it was cataloged. Since then, anyone
// who may write into the drop directory may have put something else there, such as a link to a file
// that only the reader may read. So a file is opened beneath the drop directory, without following
// symbolic links below it (base/beneath.h), and its size and hash are compared with its row.
//
// A file is opened from "/" in two cases: the catalog has no record of the drop directory (the
// catalog was written before 2026-11-25), or the row's path is not below the drop directory (which
// was elsewhere then). Then no part of the path may be a link, because no part was a link when the
// path was cataloged.
//
// The row of a file that was growing (`seen`) or could not be read has no final hash, so the
// contents are not compared. But the file must be regular, have at least the cataloged size, and
// have a single name, because a hard link to another user's file could be read, too.
//
// Threads   Functions without state; the catalog is only read.
// Errors    not_found or not_a_file if there is no regular file, or if the path leads through a
//           link; corrupt if the file is not the cataloged one; unsupported beyond 1 GiB;
//           permission; io; for a member, those of reading its archive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {

struct CatalogedBytes {
    std::vector<std::byte> bytes;
    bool is_compared = false;  // false: the row has no final hash, so any contents were accepted
};

// Reads the file of an entry, or the member of an archive.
[[nodiscard]] Result<CatalogedBytes> read_cataloged(const CatalogReader& catalog,
                                                    const CatalogEntry& entry);

// Returns the directory beneath which the path must be opened: the drop directory or "/".
[[nodiscard]] Result<std::filesystem::path> root_of(const CatalogReader& catalog,
                                                    const std::filesystem::path& path);
// Returns true if the file must have exactly the row's size and hash.
[[nodiscard]] bool has_final_hash(const CatalogEntry& entry);
// Checks a file that the caller has read by other means, by its size and hash. Errors: corrupt if
// it is not the cataloged file.
[[nodiscard]] Status check_cataloged(const CatalogEntry& entry, std::uint64_t size_bytes,
                                     std::uint64_t content_hash);

}  // namespace stormcellar::catalog

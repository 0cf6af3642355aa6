// stormcellar/catalog/read_cataloged.h -- reads cataloged raw files again.
//
// A path in the catalog names what existed there when it was cataloged. Anyone who may write into
// the drop directory may have put something else there since, such as a link to a file that only
// the reader may read. So a file is opened beneath the drop directory, with no symbolic link on the
// way down (base/beneath.h), and its size and hash are compared with its row.
//
// If the catalog does not record that directory (it was written before 2026-11-25), or the path of
// a row is elsewhere (files were once dropped there), the file is opened from "/". Then no part of
// the path may be a link; the paths of the catalog had none when they were written.
//
// A row of a file that was growing (`seen`) or could not be read has no final hash, so the contents
// are not compared. The file must still be regular, have at least the cataloged size and have a
// single name, because a hard link to another user's file would be readable, too.
//
// Threads   Functions without state; the catalog is only read.
// Errors    not_found and not_a_file for links and everything else that is no file; corrupt if it
//           is not the file that was cataloged; unsupported beyond 1 GiB; permission; io.
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

[[nodiscard]] Result<CatalogedBytes> read_cataloged(const CatalogReader& catalog,
                                                    const CatalogEntry& entry);

// Returns the directory beneath which the path must be opened.
[[nodiscard]] Result<std::filesystem::path> root_of(const CatalogReader& catalog,
                                                    const std::filesystem::path& path);
// Returns true if the row has a size and a hash that its file must have.
[[nodiscard]] bool has_final_hash(const CatalogEntry& entry);
// Checks a file that the caller read by other means. Errors: corrupt if a file of this size and
// hash is not the cataloged one.
[[nodiscard]] Status check_cataloged(const CatalogEntry& entry, std::uint64_t size_bytes,
                                     std::uint64_t content_hash);

}  // namespace stormcellar::catalog

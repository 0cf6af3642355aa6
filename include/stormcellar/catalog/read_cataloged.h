// stormcellar/catalog/read_cataloged.h -- raw files that were cataloged, read again.
//
// A path in the catalog names what stood there when it was cataloged. Whoever may write into the
// drop directory may have put something else there since, such as a link to a file that only the
// reader may read. So a file is opened beneath the drop directory, with no symbolic link on the way
// down (base/beneath.h), and what it holds is compared with its row: size and hash.
// Where the catalog does not say which directory that is (a writer of before 2026-11-25), and for a
// row whose path lies elsewhere (files were dropped there once), it is opened from "/", and then no
// part of the path may be a link: the catalog's paths had none when they were written.
// What a row cannot say is not compared: a file that was growing (`seen`) or could not be read has
// no final hash. It must be a regular file of at least the cataloged size all the same, and have
// one name: a hard link to somebody else's file is one, too. Errors: not_found and not_a_file for
// links and what else is no file, corrupt where it is not the file that was cataloged, unsupported
// beyond 1 GiB, permission, io. Thread contract: functions without state; the catalog is only read.
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
    bool is_compared = false;  // false: the row has no final hash, so any contents were taken
};

[[nodiscard]] Result<CatalogedBytes> read_cataloged(const CatalogReader& catalog,
                                                    const CatalogEntry& entry);

// The directory beneath which the path is to be opened.
[[nodiscard]] Result<std::filesystem::path> root_of(const CatalogReader& catalog,
                                                    const std::filesystem::path& path);
// Whether the row has a size and a hash that its file must have.
[[nodiscard]] bool has_final_hash(const CatalogEntry& entry);
// corrupt where a file of that size and hash is not the one that was cataloged. For whoever has
// read it otherwise.
[[nodiscard]] Status check_cataloged(const CatalogEntry& entry, std::uint64_t size_bytes,
                                     std::uint64_t content_hash);

}  // namespace stormcellar::catalog

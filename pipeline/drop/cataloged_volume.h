// pipeline/drop/cataloged_volume.h -- finds a cataloged volume, and reads its raw bytes in one
// piece.
//
// The bytes come from one file, or from the many files of a volume in chunks. A volume in chunks is
// found by the row of its first chunk, and its chunks are joined to what one file would contain.
// Each file must be unchanged since it was cataloged (stormcellar/catalog/read_cataloged.h).
//
// Threads   Functions without state; the catalog is only read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {

struct CatalogedVolume {
    std::vector<std::byte> bytes;
    // Remarks on chunks that are missing or left out. Also on files that were not compared, because
    // they were still growing when they were cataloged.
    std::vector<std::string> notes;
};

// Returns true if the volume of the entry came in chunks, one file for each.
[[nodiscard]] bool is_of_chunks(const catalog::CatalogEntry& entry);

// Returns the row of a station's volume that starts at `start`, or none. If several files have the
// volume, existing files are preferred, and among these a row for which `is_meant` is true. Errors:
// those of the catalog.
[[nodiscard]] Result<std::optional<catalog::CatalogEntry>> find_cataloged_volume(
    const catalog::CatalogReader& catalog, const std::string& station, UtcTime start,
    const std::function<bool(const catalog::CatalogEntry&)>& is_meant);

// Returns the row of the volume from which a grid was probably made. Existing files are preferred.
// Among these, an incomplete volume is preferred if `is_partial`, else a complete one.
[[nodiscard]] Result<std::optional<catalog::CatalogEntry>> find_volume_of_grid(
    const catalog::CatalogReader& catalog, const std::string& station, UtcTime start,
    bool is_partial);

// Returns a number that changes when the catalog gets further chunks of a volume. It is 0 for a
// volume in one file, and if the row of the first chunk is final (has_final_hash()). Errors: those
// of the catalog.
[[nodiscard]] Result<std::uint64_t> hash_of_growing_rows(const catalog::CatalogReader& catalog,
                                                         const catalog::CatalogEntry& entry);

// Reads a volume. Joins the chunks in the entry's directory in the order of their numbers, one for
// each number. If a file holds its chunk twice, takes it once. Leaves out chunks without a row.
// Errors: those of the catalog, of read_cataloged() and of chunks_beside().
[[nodiscard]] Result<CatalogedVolume> read_cataloged_volume(const catalog::CatalogReader& catalog,
                                                            const catalog::CatalogEntry& entry);

}  // namespace stormcellar::pipeline

// pipeline/drop/cataloged_volume.h -- finds a cataloged volume, and reads its raw bytes in one
// piece.
//
// The bytes come from one file, or from the chunks of a volume that came as one file for each
// chunk. In the latter case the row found is the first chunk's, and the joined bytes form a
// volume's file. Each file must be the one that was cataloged, by its own row
// (stormcellar/catalog/read_cataloged.h).
//
// Threads   A function without state; the catalog is only read.
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
    std::vector<std::string> notes;  // remarks: chunks that are missing or left out, and files that
                                     // were growing and so were not compared
};

// Returns true if a volume came as one file for each chunk.
[[nodiscard]] bool is_of_chunks(const catalog::CatalogEntry& entry);

// Returns the row of a station's volume that starts at this time; none if there is none. If several
// files have the volume, existing files are preferred, and then a row for which `is_meant` is true.
// Errors: those of the catalog.
[[nodiscard]] Result<std::optional<catalog::CatalogEntry>> find_cataloged_volume(
    const catalog::CatalogReader& catalog, const std::string& station, UtcTime start,
    const std::function<bool(const catalog::CatalogEntry&)>& is_meant);

// Returns the volume from which a grid was made: a complete one, if the grid is of a complete
// volume.
[[nodiscard]] Result<std::optional<catalog::CatalogEntry>> find_volume_of_grid(
    const catalog::CatalogReader& catalog, const std::string& station, UtcTime start,
    bool is_partial);

// Returns a number that changes when chunks of a volume come to the catalog. It is 0 for a volume
// in one file, and for one that has ended, whose own row says all. Errors: those of the catalog.
[[nodiscard]] Result<std::uint64_t> hash_of_growing_rows(const catalog::CatalogReader& catalog,
                                                         const catalog::CatalogEntry& entry);

// Reads a volume. Chunks are joined in the order of their numbers, one for each number, as far as
// they exist. A chunk that its file holds twice is taken once. Chunks without a row are left out.
// Errors: those of read_cataloged().
[[nodiscard]] Result<CatalogedVolume> read_cataloged_volume(const catalog::CatalogReader& catalog,
                                                            const catalog::CatalogEntry& entry);

}  // namespace stormcellar::pipeline

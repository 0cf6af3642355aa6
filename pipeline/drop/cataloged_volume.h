// pipeline/drop/cataloged_volume.h -- the raw bytes of a cataloged volume, in one piece.
//
// The bytes come from one file. If the volume came as one file a chunk, the row is that of the
// first chunk, and the joined chunks make the file of a volume. Each file must be the one that its
// own row in the catalog describes (stormcellar/catalog/read_cataloged.h). Thread contract: a
// function without state that only reads the catalog.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {

struct CatalogedVolume {
    std::vector<std::byte> bytes;
    std::vector<std::string> notes;  // what is worth saying: chunks that are missing or left out,
                                     // files that were growing and so were not compared
};

// Returns true if the volume came as one file a chunk.
[[nodiscard]] bool is_of_chunks(const catalog::CatalogEntry& entry);

// Joins the chunks that are there in the order of their numbers, one of each number. Chunks without
// a row are left out. Errors: those of read_cataloged().
[[nodiscard]] Result<CatalogedVolume> read_cataloged_volume(const catalog::CatalogReader& catalog,
                                                            const catalog::CatalogEntry& entry);

}  // namespace stormcellar::pipeline

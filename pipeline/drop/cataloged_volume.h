// pipeline/drop/cataloged_volume.h -- the raw bytes of a cataloged volume, in one piece.
//
// They come from one file, or from the chunks of the volume where it came as one file a chunk: then
// the row found is that of the first, and what is joined is a volume's file. Each file must be the
// one that was cataloged, by its own row (stormcellar/catalog/read_cataloged.h).
// Thread contract: a function without state; the catalog is only read.
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

// Whether a volume came as one file a chunk.
[[nodiscard]] bool is_of_chunks(const catalog::CatalogEntry& entry);

// Of chunks: in the order of their numbers, of each number one, as far as they lie there. Those
// without a row are left out. Errors: those of read_cataloged().
[[nodiscard]] Result<CatalogedVolume> read_cataloged_volume(const catalog::CatalogReader& catalog,
                                                            const catalog::CatalogEntry& entry);

}  // namespace stormcellar::pipeline

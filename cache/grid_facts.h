// cache/grid_facts.h -- what a grid file says of itself, without its cells.
//
// It reads what stands before the codes, and neither maps nor unpacks these. So it takes the same
// short time for a packed file: for programs that want to know of each grid what it is.
//
// Threads   Pure function, which reads a file.
#pragma once

#include <cstdint>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::cache {

struct GridFacts {
    GridDescription description;
    std::uint64_t checksum = 0;  // as GridFile::checksum()
};

// Reads the file from its beginning. It checks header and description as GridFile::open() does, but
// neither the table of bricks nor the codes. Errors: those of GridFile::open(), without a path.
[[nodiscard]] Result<GridFacts> read_grid_facts(const Descriptor& file);

}  // namespace stormcellar::cache

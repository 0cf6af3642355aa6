// cache/grid_facts.h -- reads the facts of a grid file (its header and description), without its
// cells.
//
// Only the bytes before the codes are read, so a packed file takes no longer than an unpacked one.
// Programs that list many grids use these facts.
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
    std::uint64_t checksum = 0;  // the same as GridFile::checksum()
};

// Reads the facts of an open file. Checks header and description in the same way as
// GridFile::open(), but neither the table of bricks nor the codes. Errors: those of
// GridFile::open(), without a path.
[[nodiscard]] Result<GridFacts> read_grid_facts(const Descriptor& file);

}  // namespace stormcellar::cache

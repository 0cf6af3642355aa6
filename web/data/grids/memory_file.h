// web/data/grids/memory_file.h -- bytes of an answer in a file without a name, in memory (memfd).
//
// The kernel sends the pages of a file as they are (sendfile). It copies the bytes of a string for
// each client, which was a quarter of what a kept packed grid cost.
//
// Threads   Functions without state.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "stormcellar/base/descriptor.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// Each takes a descriptor while it is kept, so that small ones are not worth it.
inline constexpr std::size_t least_in_memory_file = std::size_t{256} << 10;

// Writes at the file's position. Returns false where there is no room.
[[nodiscard]] bool write_all(const Descriptor& file, std::span<const std::byte> bytes);

// Returns the bytes as they are sent best: in a file if they are many and a file can be had. Ranges
// of a file share it, those of a text are copies.
[[nodiscard]] Piece in_file(const Text& text);

}  // namespace stormcellar::web

// web/data/grids/memory_file.h -- holds the bytes of an answer in a nameless file in memory
// (memfd).
//
// The kernel sends the pages of a file without copying them (sendfile), but it copies a string for
// each client. Copying was a quarter of the cost of sending a kept packed grid.
//
// Threads   Functions without state.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "stormcellar/base/descriptor.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// Each file holds a descriptor as long as it is kept, so smaller answers stay strings.
inline constexpr std::size_t least_in_memory_file = std::size_t{256} << 10;

// Writes at the present position of the file. Returns false if there is no room.
[[nodiscard]] bool write_all(const Descriptor& file, std::span<const std::byte> bytes);

// Returns the bytes in a file if there are at least `least_in_memory_file` and a file can be made.
// Otherwise returns the text. A part of a file shares the file; a part of a text is a copy.
[[nodiscard]] Piece in_file(const Text& text);

}  // namespace stormcellar::web

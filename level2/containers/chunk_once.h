// level2/containers/chunk_once.h -- removes repetitions from a file to which one chunk was appended
// several times.
//
// After a crash, LDM's pqact files products again. If it appends them, the file of a chunk holds
// the chunk twice, or a part of the chunk and then the whole chunk.
//
// Threads   Pure function.
#pragma once

#include <cstddef>
#include <span>

namespace stormcellar::level2 {

// Returns one copy of the chunk if the bytes are recognized as repetitions of it, else all bytes.
// Content other than LDM records is returned unchanged.
[[nodiscard]] std::span<const std::byte> chunk_once(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2

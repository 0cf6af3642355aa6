// level2/containers/chunk_once.h -- removes repetitions from the file of a chunk that was appended
// again.
//
// After a crash, LDM's pqact files products again. If it appends, a file of one chunk then holds
// the chunk twice, or a part of it and then all of it.
//
// Threads   Pure function.
#pragma once

#include <cstddef>
#include <span>

namespace stormcellar::level2 {

// Returns the part of the bytes that holds each byte of the chunk once; all bytes if nothing is
// repeated.
[[nodiscard]] std::span<const std::byte> chunk_once(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2

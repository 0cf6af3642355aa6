// render/gif_lzw.h -- the compression of GIF pixel data.
// Source: GIF89a specification (CompuServe 1990), appendix F.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stormcellar::render {

// Appends the minimum code size, the data in sub-blocks of at most 255 bytes and the terminator.
// Every index must be below 1 << index_bits; index_bits is 2 to 8.
void append_gif_lzw(std::span<const std::uint8_t> indices, int index_bits,
                    std::vector<std::byte>& out);

}  // namespace stormcellar::render

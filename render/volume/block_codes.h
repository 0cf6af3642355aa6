// render/volume/block_codes.h -- finds the range of values in each block of a brick.
//
// Threads   Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace stormcellar::render {

// Blocks are cubes of `edge` cells: 2, 4, 8 or 16. Block (x, y, z) has the number (x * across + y)
// * across + z. In a block without a value, `largest` is below grid::first_value_code and `least`
// has no meaning.
struct BlockCodes {
    static constexpr std::size_t most = 512;
    int across = 0;  // blocks along each axis
    std::array<std::uint16_t, most> least, largest;
};

// Finds the ranges for the codes of one whole brick (stormcellar/grid/brick_view.h). A code has 1
// or 2 bytes.
void find_block_codes(const std::byte* codes, int code_bytes, int edge, BlockCodes& found);

}  // namespace stormcellar::render

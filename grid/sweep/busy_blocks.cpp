#include "grid/sweep/busy_blocks.h"

#include <algorithm>

namespace stormcellar::grid {
namespace {

bool is_all_zero(const std::uint8_t* codes, std::size_t count) {
    std::uint8_t any = 0;
    for (std::size_t i = 0; i < count; ++i)
        any |= codes[i];
    return any == 0;
}

}  // namespace

BusyBlocks::BusyBlocks(std::size_t rows, std::size_t gates)
    : words_a_row_(gates / (64 * gates_a_block) + 1), words_(rows * words_a_row_) {}

void BusyBlocks::mark(std::size_t row, std::span<const std::uint8_t> codes) {
    std::uint64_t* words = words_.data() + row * words_a_row_;
    const std::size_t whole = codes.size() / gates_a_block;
    for (std::size_t block = 0; block < whole; ++block) {
        const bool busy = !is_all_zero(codes.data() + block * gates_a_block, gates_a_block);
        words[block / 64] |= std::uint64_t{busy} << (block % 64);
    }
    const std::size_t rest = codes.size() - whole * gates_a_block;
    if (rest == 0) return;
    const bool busy = !is_all_zero(codes.data() + whole * gates_a_block, rest);
    words[whole / 64] |= std::uint64_t{busy} << (whole % 64);
}

}  // namespace stormcellar::grid

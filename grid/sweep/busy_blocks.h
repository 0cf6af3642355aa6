// grid/sweep/busy_blocks.h -- marks the parts of a sweep's radials that hold anything but no echo.
//
// There is a mark for each block of 32 gates of each radial. An unmarked block holds only code 0,
// which is no echo.
//
// Threads   Immutable after the last mark().
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stormcellar::grid {

class BusyBlocks {
  public:
    BusyBlocks() = default;
    // Makes room for `rows` radials, each with at most `gates` gates.
    BusyBlocks(std::size_t rows, std::size_t gates);

    // Marks the blocks of a radial. If the radial has fewer gates than `gates`, the missing gates
    // count as no echo.
    void mark(std::size_t row, std::span<const std::uint8_t> codes);

    // The blocks from one gate to another, both included. Both gates must be below `gates`.
    struct Stretch {
        std::size_t first = 0, last = 0;
    };
    [[nodiscard]] static Stretch blocks_of(std::int32_t first_gate, std::int32_t last_gate) {
        return {static_cast<std::size_t>(first_gate) / gates_a_block,
                static_cast<std::size_t>(last_gate) / gates_a_block};
    }
    [[nodiscard]] bool is_quiet(std::size_t row, Stretch blocks) const {
        const std::uint64_t* words = words_.data() + row * words_a_row_;
        std::size_t word = blocks.first / 64;
        const std::size_t last_word = blocks.last / 64;
        std::uint64_t mask = ~std::uint64_t{0} << (blocks.first % 64);
        for (; word < last_word; ++word, mask = ~std::uint64_t{0})
            if ((words[word] & mask) != 0) return false;
        mask &= ~std::uint64_t{0} >> (63 - blocks.last % 64);
        return (words[word] & mask) == 0;
    }
    [[nodiscard]] bool is_empty() const { return words_a_row_ == 0; }

  private:
    static constexpr std::size_t gates_a_block = 32;

    std::size_t words_a_row_ = 0;
    std::vector<std::uint64_t> words_;
};

}  // namespace stormcellar::grid

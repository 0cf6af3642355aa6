// bunzip/symbol_reader.h -- reads the symbols of a block, in groups of 50, each with its own code.
//
// Threads   One thread at a time. The constructor's arguments must outlive the reader.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/bit_reader.h"
#include "bunzip/block_tables.h"

namespace stormcellar::bunzip {

class SymbolReader {
  public:
    SymbolReader(BitReader& reader, const BlockTables& tables) : reader_(reader), tables_(tables) {}

    static constexpr std::size_t batch_groups = 20;
    static constexpr std::size_t batch_symbols = batch_groups * group_symbols;

    // Returns the next symbols, without the end of the block. They are valid until the next call.
    // If found() is not good afterward, the symbols before the bad or cut place are returned.
    [[nodiscard]] std::span<const std::uint16_t> next_batch();
    // Returns true if the end of the block was read; then the bit reader is just after it.
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] Found found() const { return found_; }

  private:
    // Read a group to `to`, and return the place after its symbols. Both functions stop at the end
    // of the block, or when they set found_ to cut or bad.
    std::uint16_t* read_group(const PrefixCode& code, std::uint16_t* to);
    std::uint16_t* read_last_group(const PrefixCode& code, std::uint16_t* to);

    BitReader& reader_;
    const BlockTables& tables_;
    std::size_t group_ = 0;
    bool ended_ = false;
    Found found_ = Found::good;
    std::array<std::uint16_t, batch_symbols> batch_;
};

}  // namespace stormcellar::bunzip

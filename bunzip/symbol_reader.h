// bunzip/symbol_reader.h -- reads the symbols of a block, in groups of 50, each with its own code.
//
// Threads   One thread at a time. The objects that it refers to must outlive it.
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

    // Returns the next symbols, without the end of the block, valid until the next call. Symbols
    // before a bad or cut place are returned too; found() then gives the reason.
    [[nodiscard]] std::span<const std::uint16_t> next_batch();
    // Returns true if the end of the block was read; then the bit reader is just after it.
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] Found found() const { return found_; }

  private:
    // Returns the place after the symbols that were read. Stops where the block ends or found_ is
    // not good.
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

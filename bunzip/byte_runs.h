// bunzip/byte_runs.h -- makes the last column of the sorted block, as runs of bytes, from the
// symbols.
//
// A symbol from 2 on is a place in a list of bytes; the byte at this place moves to the front.
// Symbols 0 and 1 are the digits 1 and 2 of a number, which counts how many more times the front
// byte occurs. Each digit is worth twice the previous one.
//
// The kind of the next symbol cannot be predicted, so the runs are made in one pass without a
// branch on it. A mask of 64 symbols says which are moves, and the mask of the digits between two
// moves gives the length of a run. The list is in registers as far as the Path allows.
//
// Threads   One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/bzip2_format.h"
#include "bunzip/paths.h"

namespace stormcellar::bunzip {

// A byte and the number of times that it occurs, which is 0 only in the first run of a block.
class ByteRun {
  public:
    ByteRun() = default;
    ByteRun(std::uint8_t byte, std::uint32_t length) : packed_(length << 8 | byte) {}
    [[nodiscard]] std::uint8_t byte() const { return static_cast<std::uint8_t>(packed_); }
    [[nodiscard]] std::uint32_t length() const { return packed_ >> 8; }

  private:
    std::uint32_t packed_;
};

struct RunMaker {
    alignas(64) std::array<std::uint8_t, 256> list{};  // the front first
    std::uint32_t digits = 0;                          // number of digits after the last move
    std::uint32_t digit_bits = 0;                      // which of them are 1, the first one lowest
    std::uint32_t times = 0;                           // 0 before the first move, then 1
    std::uint64_t bytes = 0;                           // bytes in the runs that have ended
    std::array<std::uint32_t, 256> count{};            // number of each byte in those runs

    void begin(std::span<const std::uint8_t> bytes_there);
};

// Appends to `to` the runs that end within `symbols`, at most as many as there are symbols, and
// returns their number. A run that continues is kept for the next call. If it has too many digits,
// or `bytes` exceeds a block's size, the block is bad and there must be no next call.
using MakeRuns = std::size_t (*)(RunMaker& maker, std::span<const std::uint16_t> symbols,
                                 ByteRun* to);
[[nodiscard]] MakeRuns make_runs_by(Path path);
// Returns the run that remains at the end of a block.
[[nodiscard]] ByteRun last_run(RunMaker& maker);

}  // namespace stormcellar::bunzip

// bunzip/byte_runs.h -- makes runs of bytes from symbols. The runs are the last column of the
// sorted block.
//
// A symbol n of 2 or more moves the byte at place n - 1 of a list to the front, and begins a run of
// this byte. Symbols 0 and 1 are the digits 1 and 2 of a number by which the run of the front byte
// grows. In this number, a digit counts twice as much as the same digit one place before.
//
// The kind of the next symbol cannot be predicted, so the fast paths do not branch on it. They make
// a mask of the moves in 64 symbols; the mask of the digits between two moves gives the length of a
// run. The list is in registers as far as the Path allows.
//
// Threads   One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/bzip2_format.h"
#include "bunzip/paths.h"

namespace stormcellar::bunzip {

// A byte and its number of repetitions, which is 0 only for the first run of a block.
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
    std::uint32_t digit_bits = 0;            // bit i: digit i after the last move is symbol 1
    std::uint32_t times = 0;                 // 0 before the first move, then 1
    std::uint64_t bytes = 0;                 // bytes in the runs that have ended
    std::array<std::uint32_t, 256> count{};  // number of each byte value in ended runs

    void begin(std::span<const std::uint8_t> bytes_there);
};

// Appends to `to` the runs that end within `symbols`, at most as many as there are symbols, and
// returns their number. `maker` keeps a run that continues for the next call. If a run has too many
// digits, RunMaker::bytes exceeds every block. Once RunMaker::bytes exceeds the size of a block,
// the block is bad and there must be no next call.
using MakeRuns = std::size_t (*)(RunMaker& maker, std::span<const std::uint16_t> symbols,
                                 ByteRun* to);
[[nodiscard]] MakeRuns make_runs_by(Path path);
// Ends the block, and returns its last run.
[[nodiscard]] ByteRun last_run(RunMaker& maker);

}  // namespace stormcellar::bunzip

// bunzip/byte_runs.h -- from symbols to the last column of the sorted block, as runs of bytes.
//
// A symbol from 2 on names a place in a list of bytes, whose byte then moves to the front. Symbols
// 0 and 1 are the digits of the number of further times that the front byte stands there: 1 or 2,
// each worth twice the one before.
// The runs come out in one pass without a branch on the kind of a symbol, since that cannot be
// foreseen: a mask of 64 symbols says which are moves, and a run's length is read from the digits'
// mask between two of them. The list is held in registers as far as they go (Path).
// Thread contract: one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/bzip2_format.h"
#include "bunzip/paths.h"

namespace stormcellar::bunzip {

// A byte and how often it stands there, at least once but for the first run of a block.
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
    std::uint32_t digits = 0;                          // behind the last move
    std::uint32_t digit_bits = 0;                      // which of them are 1, the first lowest
    std::uint32_t times = 0;                           // 0 before the first move, then 1
    std::uint64_t bytes = 0;                           // in the runs that are ended
    std::array<std::uint32_t, 256> count{};            // of each byte, in those

    void begin(std::span<const std::uint8_t> bytes_there);
};

// Appends to `to` the runs that end inside `symbols`, at most as many, and says how many those
// are. The run that goes on is kept for the next call; bad where it has too many digits. Once
// `bytes` is above a block's, the block is bad, and there is no next call.
using MakeRuns = std::size_t (*)(RunMaker& maker, std::span<const std::uint16_t> symbols,
                                 ByteRun* to);
[[nodiscard]] MakeRuns make_runs_by(Path path);
// What is left at the end of a block.
[[nodiscard]] ByteRun last_run(RunMaker& maker);

}  // namespace stormcellar::bunzip

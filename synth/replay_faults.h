// synth/replay_faults.h -- what goes wrong on the way to a drop directory, on purpose.
//
// What comes is a row: a file's pieces where they come one by one, else the files in their order.
//   drop      it never comes. In a file that grows its bytes are missing in the midst.
//   repeat    it comes a second time behind itself: appended again, or its file written again with
//             the same bytes.
//   reorder   it comes behind the next of its row.
//   truncate  its last bytes are missing, one at least and not all: a random number.
// Each has one fault at most; one behind which a reordered one comes has none. The last of a row is
// not reordered, and a piece of less than two bytes not truncated. Random numbers depend on the
// seed and on the place in the row alone: the same sources give the same faults at any speed.
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::synth {

enum class Fault : std::uint8_t { none, drop, repeat, reorder, truncate };
[[nodiscard]] std::string_view to_string(Fault fault);

struct FaultRates {
    double drop = 0, repeat = 0, reorder = 0, truncate = 0;  // probabilities; at most 1 in all
    std::uint32_t seed = 1;
};

// "drop=0.01,repeat=0.01,reorder=0.02,truncate=0.005,seed=7": any of them, each once at most.
// Errors: bad_argument, with what is wrong and what there is.
[[nodiscard]] Result<FaultRates> parse_fault_rates(std::string_view text);

// One write. A dropped one is listed too, with nothing to write.
struct Arrival {
    std::size_t piece = 0;
    Fault fault = Fault::none;
    bool again = false;  // the second of a repeated one
    double kept = 1;     // of its bytes, in (0, 1)
};

// In the order in which they come. `row` is the number of the row.
[[nodiscard]] std::vector<Arrival> arrivals_of(const FaultRates& rates, std::uint32_t row,
                                               std::size_t pieces);
// What is left of so many bytes: all of them unless it was truncated.
[[nodiscard]] std::size_t kept_bytes(const Arrival& arrival, std::size_t bytes);

}  // namespace stormcellar::synth

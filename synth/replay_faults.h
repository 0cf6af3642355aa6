// synth/replay_faults.h -- makes deliberate faults in the files that a replay writes.
//
// A fault affects one element of a row. If files come piece by piece, each file is a row and its
// pieces are the elements. Otherwise, all files together are one row, and each is an element.
//   drop      The element never comes. If its file grows, its bytes are missing in the middle.
//   repeat    The element comes twice in succession: a piece is appended again, or a file is
//             written again with the same bytes.
//   reorder   The element comes after the next element of its row.
//   truncate  The element's last bytes are missing: a random number of them, at least one and not
//             all.
// An element has at most one fault. An element right after a reordered element has no fault. The
// last element of a row is not reordered, and an element of less than two bytes is not truncated.
// Random numbers depend only on the seed and on the place in the row, so the same sources get the
// same faults at any speed.
//
// Threads   Pure functions.
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
    // probabilities; their sum is at most 1
    double drop = 0, repeat = 0, reorder = 0, truncate = 0;
    std::uint32_t seed = 1;
};

// Parses "drop=0.01,repeat=0.01,reorder=0.02,truncate=0.005,seed=7". Each name may be left out.
// Errors: bad_argument; the message says what is wrong and what is allowed.
[[nodiscard]] Result<FaultRates> parse_fault_rates(std::string_view text);

// One write of an element. A dropped element also has an arrival, but nothing is written.
struct Arrival {
    std::size_t piece = 0;
    Fault fault = Fault::none;
    bool again = false;  // the second write of a repeated element
    double kept = 1;     // share of its bytes, in (0, 1)
};

// Returns the writes in their order. `row` is the number of the row.
[[nodiscard]] std::vector<Arrival> arrivals_of(const FaultRates& rates, std::uint32_t row,
                                               std::size_t pieces);
// Returns how many of these bytes are kept: all, unless the element is truncated.
[[nodiscard]] std::size_t kept_bytes(const Arrival& arrival, std::size_t bytes);

}  // namespace stormcellar::synth

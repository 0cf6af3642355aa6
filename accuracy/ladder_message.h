// accuracy/ladder_message.h -- sums up a ladder in one sentence.
//
// Threads   Pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stormcellar/accuracy/ladder.h"

namespace stormcellar::accuracy {

struct LadderMessage {
    std::string step;    // the step whose rungs are compared
    std::string buy;     // "eight-point costs 6 times the time of linear and halves the error"
    std::string beyond;  // "beyond it, exact costs 40 times the time of that ..."; or empty

    // Returns `buy` and `beyond`, separated by a semicolon; empty if `buy` is empty.
    [[nodiscard]] std::string sentence() const;
};

// Compares the rungs of one step by their error (the 99th percentile of the value, else of the
// color) and by their time (kept_time_s if known, else time_s). The base is the default rung (its
// name ends with "(default)"), else the fastest. `buy` names the fastest slower rung on the front
// whose error is at least a tenth smaller, else the fastest that is better at all; or it says that
// there is none. `beyond` names the still slower rung that gains most for its time: the one with
// the largest ratio of the logarithms of the fall of the error and the rise of the time, or an
// exact rung if there is no other. With fewer than two rungs that have an error, the message is
// empty. Ratios have two digits.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, std::string_view step,
                                       ValueUnit unit);

// Returns the message of the step "chain" (whole chains) if there is one, else of the step with the
// most rungs.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy

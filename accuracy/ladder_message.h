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
    std::string step;  // the step whose rungs are compared
    // Says which rung is worth its time, as in "eight-point costs 6 times the time of linear and
    // halves the error".
    std::string buy;
    // Says which slower rung comes next, as in "beyond it, exact costs 40 times the time of that
    // ..."; or empty.
    std::string beyond;

    // Returns `buy` and `beyond`, separated by a semicolon; empty if `buy` is empty.
    [[nodiscard]] std::string sentence() const;
};

// Compares the rungs of one step by error and time. The error of a rung is the 99th percentile of
// the errors of its values, or of its colors if the row has no values. The time is kept_time_s, or
// time_s if kept_time_s is unknown.
//
// The base is the default rung, whose name ends with "(default)", or else the fastest rung. It is
// compared with the rungs that are slower than the base, are on the Pareto front, and have a
// smaller error. `buy` names the fastest of them whose error is at least a tenth smaller than the
// base's. If none of the compared rungs gains a tenth, `buy` names the fastest compared rung. If
// there is no rung to compare with the base, `buy` says so.
//
// `beyond` looks at the rungs that are slower and more accurate than the rung in `buy`. `beyond`
// names the rung with the largest ratio of log(fall of the error) to log(rise of the time). A rung
// whose error is 0 is named only if there is no other.
//
// The message is empty if fewer than two rungs have an error and a time. In its text, ratios from
// 10 on are whole numbers; smaller ratios have at most one decimal.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, std::string_view step,
                                       ValueUnit unit);

// Returns the message for the step "chain" (whole chains). If there is no such step, returns the
// message for the step with the most rows.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy

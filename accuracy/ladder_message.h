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
    // The rung worth its time, as in "eight-point costs 6 times the time of linear and halves the
    // error".
    std::string buy;
    // The rung after that, as in "beyond it, exact costs 40 times the time of that ..."; or empty.
    std::string beyond;

    // Returns `buy` and `beyond`, separated by a semicolon; empty if `buy` is empty.
    [[nodiscard]] std::string sentence() const;
};

// Compares the rungs of one step by error and time. The error is the 99th percentile of the value,
// or of the color if a row has no value. The time is kept_time_s, or time_s if that is unknown.
//
// The base is the default rung, whose name ends with "(default)", or else the fastest rung. All
// rungs that are compared with the base are slower, are on the Pareto front and have a smaller
// error. `buy` names the fastest of these rungs whose error is at least a tenth smaller than the
// base's, or the fastest of all if no rung gains a tenth. If no rung is better, `buy` says so.
//
// `beyond` names one of the rungs that are still slower and better than the rung in `buy`: the rung
// with the largest ratio of log(fall of the error) to log(rise of the time). A rung without any
// error is named only if there is no other.
//
// The message is empty if fewer than two rungs have an error and a time. In its text, ratios from
// 10 on are whole numbers; smaller ratios have at most one decimal.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, std::string_view step,
                                       ValueUnit unit);

// Returns the message for the step "chain" (whole chains). If there is no such step, returns the
// message for the step with the most rows.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy

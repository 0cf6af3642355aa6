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
    std::string step;    // the step whose rungs it compares
    std::string buy;     // "eight-point costs 6 times the time of linear and halves the error"
    std::string beyond;  // "beyond it, exact takes 40 times as long for no error"; or empty

    // Returns "Of the chain, eight-point costs ...; beyond it, ..."
    [[nodiscard]] std::string sentence() const;
};

// Compares the rungs of one step, by the time of further runs if it is known, else by the time of
// the first, and by the 99th percentile of the value or the color. The base is the default rung
// (its name ends with "(default)"), else the fastest. `buy` names the next step up: the fastest
// slower rung on the front whose error is at least a tenth smaller. `beyond` names the still slower
// rung that gains most for its time, by the ratio of the logarithms of the fall of the error and
// the rise of the time; an exact rung comes last. Without errors, or with a single rung, the
// message is empty. Ratios have two digits.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, std::string_view step,
                                       ValueUnit unit);

// Returns the message of the step that sums the ladder up: the step of whole chains, or else the
// one with the most rungs.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy

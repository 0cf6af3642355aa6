// accuracy/ladder_message.h -- what a ladder says, in one sentence.
//
// Threads   Pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stormcellar/accuracy/ladder.h"

namespace stormcellar::accuracy {

struct LadderMessage {
    std::string step;    // whose rungs it compares
    std::string buy;     // "eight-point costs 6 times the time of linear and halves the error"
    std::string beyond;  // "beyond it, exact takes 40 times as long for no error"; or empty

    // "Of the chain, eight-point costs ...; beyond it, ..."
    [[nodiscard]] std::string sentence() const;
};

// Compares the rungs of one step, by the time of further runs if there is one, else of the first,
// and by the 99th percentile of the value or the color. The base is the rung that is the default
// (its name ends with "(default)"), else the fastest. `buy` names the next step up:
// the fastest slower rung that is worth it and whose error is at least a tenth smaller. `beyond`
// names the slower one that gains most for its time: that with the greatest ratio of the logarithms
// of what the error falls and the time grows by, an exact one last. Without errors, or with a
// single rung, the message is empty. Ratios have two digits.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, std::string_view step,
                                       ValueUnit unit);

// The message of the step that sums the ladder up: that of whole chains, else the one with the most
// rungs.
[[nodiscard]] LadderMessage message_of(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy

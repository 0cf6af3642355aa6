// accuracy/explain.h -- the text of `--explain`: the size of each effect, the budget, what is on or
// off, and why.
//
// Lines have at most 80 characters if words allow it. The text of a plan is the same on every
// machine (measured times belong to the plan and not to the writer). Sizes are rounded up to three
// digits.
//
// Threads   A pure function.
#pragma once

#include <string>

#include "stormcellar/accuracy/plan.h"

namespace stormcellar::accuracy {

[[nodiscard]] std::string explain(const Plan& plan);

}  // namespace stormcellar::accuracy

// accuracy/explain.h -- writes the text of `--explain`: the budget, and for each effect its size,
// whether it is on or off, and why.
//
// Explanations are wrapped at 80 characters; other lines may be longer. Sizes are rounded up to
// three digits. The same plan gives the same text on every machine.
//
// Threads   A pure function.
#pragma once

#include <string>

#include "stormcellar/accuracy/plan.h"

namespace stormcellar::accuracy {

[[nodiscard]] std::string explain(const Plan& plan);

}  // namespace stormcellar::accuracy

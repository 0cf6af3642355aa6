// accuracy/explain.h -- the text of `--explain`: each effect's size, the budget, on or off, why.
//
// Lines of at most 80 characters where words allow it, the same text for the same plan on
// every machine (times that were measured are the plan's, not the writer's). Sizes are rounded
// up to three digits. Thread contract: a pure function.
#pragma once

#include <string>

#include "stormcellar/accuracy/plan.h"

namespace stormcellar::accuracy {

[[nodiscard]] std::string explain(const Plan& plan);

}  // namespace stormcellar::accuracy

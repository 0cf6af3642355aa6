// tests/testing/forced_choice.h -- a plan's choice with one effect forced on or off.
#pragma once

#include <string>

#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/plan.h"

namespace stormcellar::testing {

// Returns the plan's choice with one change. If `on`, the effect and all effects that it requires
// are on. Otherwise the effect and all effects that require it are off.
inline accuracy::Choice forced(const accuracy::Plan& plan, const accuracy::Chain& chain,
                               const std::string& effect, bool on) {
    accuracy::Choice choice = plan.choice;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const auto& effects = chain.steps[i].effects;
        for (std::size_t k = 0; k < effects.size(); ++k) {
            if (effects[k].name == effect) choice.rungs[i] = on ? k + 1 : k;
        }
    }
    return choice;
}

}  // namespace stormcellar::testing

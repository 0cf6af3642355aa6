#include "service/pulse.h"

namespace stormcellar {

std::optional<Step> Pulses::oldest() const {
    std::optional<Step> oldest;
    for (const auto& [who, pulse] : all_) {
        const auto since = pulse->since();
        if (since && (!oldest || *since < oldest->since)) oldest = Step{who, *since};
    }
    return oldest;
}

}  // namespace stormcellar

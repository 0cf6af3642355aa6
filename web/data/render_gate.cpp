#include "web/data/render_gate.h"

namespace stormcellar::web {

std::optional<RenderGate::Pass> RenderGate::enter() {
    std::unique_lock lock(mutex_);
    if (free_ == 0) {
        if (may_wait_ == 0) return std::nullopt;
        --may_wait_;
        const bool is_free = left_.wait_for(lock, patience_, [this] { return free_ > 0; });
        ++may_wait_;
        if (!is_free) return std::nullopt;
    }
    --free_;
    return Pass(this);
}

void RenderGate::leave() {
    {
        const std::scoped_lock lock(mutex_);
        ++free_;
    }
    left_.notify_one();
}

}  // namespace stormcellar::web

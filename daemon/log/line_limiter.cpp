#include "daemon/log/line_limiter.h"

#include <algorithm>

namespace stormcellar::daemon {

bool LineLimiter::allow(Event event, std::string_view subject, LogLevel level, SteadyTime now) {
    const Most most = most_of(event);
    std::pair<Event, std::string> key{event, subject};
    auto found = each_.find(key);
    if (found == each_.end() && each_.size() < most_subjects)
        found = each_.try_emplace(std::move(key), Kind{RateLimit{most.of_one, period}}).first;
    if (found != each_.end() && !found->second.limit.allow(now)) {
        found->second.gravest = std::max(found->second.gravest, level);
        return false;
    }
    Kind& all = all_.try_emplace(event, Kind{RateLimit{most.of_all, period}}).first->second;
    if (all.limit.allow(now)) return true;
    all.gravest = std::max(all.gravest, level);
    return false;
}

void LineLimiter::take(Kind& kind, Event event, const std::string& subject, SteadyTime now,
                       std::vector<HeldBack>& held) {
    const auto lines = kind.limit.take_held_back(now);
    if (!lines) return;
    held.push_back({event, subject, kind.gravest, *lines});
    kind.gravest = LogLevel::debug;
}

std::vector<LineLimiter::HeldBack> LineLimiter::take_held_back(SteadyTime now) {
    std::vector<HeldBack> held;
    for (auto& [key, kind] : each_)
        take(kind, key.first, key.second, now, held);
    for (auto& [event, kind] : all_)
        take(kind, event, {}, now, held);
    std::erase_if(each_, [&](const auto& each) { return each.second.limit.is_idle(now); });
    return held;
}

}  // namespace stormcellar::daemon

#include "stormcellar/cache/budget.h"

#include <algorithm>

#include "stormcellar/base/station_table.h"

namespace stormcellar::cache {

const Budget& Budgets::of(std::string_view group) const {
    const auto named = domains.find(group);
    return named == domains.end() ? every_domain : named->second;
}

std::optional<std::chrono::milliseconds> Budgets::age_of(std::string_view group) const {
    const auto own = of(group).age;
    if (!own || !total.age) return own ? own : total.age;
    return std::min(*own, *total.age);
}

bool Budgets::makes_room(std::string_view group) const {
    return total.limits_space() || of(group).limits_space();
}

std::uint64_t Budgets::low_mark(std::uint64_t limit) const {
    return std::min(limit, static_cast<std::uint64_t>(static_cast<double>(limit) * low_watermark));
}

bool is_known_group(std::string_view group) {
    return !is_icao(group) || find_station(group).has_value();
}

}  // namespace stormcellar::cache

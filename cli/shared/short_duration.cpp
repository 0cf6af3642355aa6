#include "cli/shared/short_duration.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::cli {

std::string short_duration(std::optional<double> seconds) {
    if (!seconds || !std::isfinite(*seconds)) return "-";
    if (std::isless(*seconds, 0.0)) return "-" + short_duration(-*seconds);
    using Unit = std::pair<double, const char*>;
    // Each unit is used below its limit. From the limit on, the next larger unit is shorter to
    // write.
    static constexpr std::array<Unit, 5> units = {
        Unit{1, "s"}, {60, "min"}, {3600, "h"}, {86'400, "d"}, {365.25 * 86'400, "y"}};
    static constexpr std::array<double, 4> ends = {100, 100 * 60, 48 * 3600, 1000 * 86'400.0};
    if (*seconds < 0.9995) return fmt::format("{:.0f} ms", *seconds * 1000);
    std::size_t unit = 0;
    while (unit < ends.size() && *seconds >= ends.at(unit))
        ++unit;
    const double value = *seconds / units.at(unit).first;
    return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, units.at(unit).second);
}

}  // namespace stormcellar::cli

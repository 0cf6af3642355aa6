#include "render/view/length_text.h"

#include <cmath>

#include <fmt/format.h>

namespace stormcellar::render {
namespace {

double rounded(double number, int digits) {
    if (!std::isfinite(number) || std::fpclassify(number) == FP_ZERO) return number;
    const double power = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(number))));
    return std::round(number * power) / power;
}

std::string length_text(double metres, Unit unit) {
    const UnitFacts& facts = facts_of(unit);
    if (unit == Unit::km && metres < facts.si) return number_text(metres) + " m";
    const double number = metres / facts.si;
    const bool is_round = std::abs(rounded(number, 6) - number) <= 1e-9 * std::abs(number);
    return fmt::format("{} {}", number_text(number, is_round ? 6 : 3), facts.symbol);
}

}  // namespace

std::string number_text(double number, int digits) {
    return fmt::format("{:.12g}", rounded(number, digits));
}

std::string value_text(float value, const ShownUnit& unit, int digits) {
    const std::string number = number_text(unit.per_stored * static_cast<double>(value), digits);
    return unit.symbol.empty() ? number : number + " " + unit.symbol;
}

std::string distance_text(double metres, const Units& units) {
    return length_text(metres, units.distance);
}

std::string height_text(double metres, const Units& units) {
    return length_text(metres, units.height);
}

std::string motion_text(const retrieve::Motion& motion, const Units& units) {
    const UnitFacts& unit = facts_of(units.speed);
    return fmt::format("motion from {:.0f} degrees at {} {}",
                       std::fmod(std::round(motion.direction_deg()), 360.0),
                       number_text(motion.speed_mps() / unit.si, 3), unit.symbol);
}

double round_distance(double metres, const Units& units) {
    if (units.distance == Unit::km) return metres;
    const double unit_m = facts_of(units.distance).si;
    const double number = metres / unit_m;
    const double power = std::pow(10.0, std::floor(std::log10(number)));
    double nearest = power;
    for (const double digit : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
        const double candidate = digit * power;
        if (std::abs(std::log(candidate / number)) < std::abs(std::log(nearest / number)))
            nearest = candidate;
    }
    return nearest * unit_m;
}

double height_step_unit_m(const Units& units) {
    const double unit_m = facts_of(units.height).si;
    return unit_m < 1 ? 1000 * unit_m : unit_m;
}

}  // namespace stormcellar::render

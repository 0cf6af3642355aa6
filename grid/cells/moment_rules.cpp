#include "grid/cells/moment_rules.h"

#include <array>

#include "stormcellar/grid/audit_row.h"

namespace stormcellar::grid {
namespace {

using accuracy::ValueUnit;
using level2::Moment;

constexpr auto moment_rules = std::to_array<MomentRules>({
    {Moment::ref, {1, -32, 0.5F}, ValueUnit::db, true},
    {Moment::vel, {2, -256, 0.25F}, ValueUnit::mps, false, "each measures along its own beams"},
    {Moment::sw, {1, 0, 0.25F}, ValueUnit::mps},
    {Moment::zdr, {2, -32, 0.03125F}, ValueUnit::db},
    {Moment::phi, {2, 0, 0.25F}, ValueUnit::degree, false, "each has an offset of its own"},
    {Moment::rho, {2, 0, 0.001953125F}, ValueUnit::ratio},
    {Moment::cfp, {2, -256, 0.25F}, ValueUnit::db},
    {Moment::veld,
     {2, -1024, 0.25F, true},
     ValueUnit::mps,
     false,
     "each measures along its own beams"},
    {Moment::srv,
     {2, -1024, 0.25F, true},
     ValueUnit::mps,
     false,
     "each measures along its own beams, relative to its own storm motion"},
    {Moment::azsh,
     {2, -1024, 0.03125F, true},
     ValueUnit::per_1000_s,
     false,
     "each measures along its own beams",
     true},
    {Moment::divg,
     {2, -1024, 0.03125F, true},
     ValueUnit::per_1000_s,
     false,
     "each measures along its own beams"},
    {Moment::pow, {1, -0.004F, 0.004F, true}, ValueUnit::ratio},
    {Moment::kdp, {2, -64, 0.00390625F, true}, ValueUnit::degree_per_km},
    {Moment::rate, {2, -0.015625F, 0.015625F, true}, ValueUnit::mm_per_h},
    {Moment::hca, {1, -10, 10, true}, ValueUnit::ratio, false, "classes have no mean"},
});
static_assert(level2::has_a_row_for_each_moment(moment_rules));

}  // namespace

const MomentRules& rules_of(Moment moment) {
    return moment_rules[static_cast<std::size_t>(moment)];
}

Quantization default_quantization(Moment moment) {
    return rules_of(moment).quantization;
}

std::string_view difference_unit(Moment moment) {
    const std::string_view units = level2::moment_units(moment);
    return units == "dBZ" ? "dB" : units;  // the ratio of two values of Z is in dB
}

}  // namespace stormcellar::grid

#include "export/cfradial_layout.h"

#include <algorithm>
#include <bit>
#include <optional>

#include <fmt/format.h>

namespace stormcellar::netcdf {
namespace {

using level2::SweepMoment;

// Returns true if both have the same bits. So two scales that are NaN count as the same scale.
bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool same_packing(const SweepMoment& a, const SweepMoment& b) {
    return a.moment == b.moment && a.word_size_bits == b.word_size_bits &&
           same_bits(a.scale, b.scale) && same_bits(a.offset, b.offset);
}

bool same_geometry(const SweepMoment& a, const SweepMoment& b) {
    return a.first_gate_m == b.first_gate_m && a.gate_spacing_m == b.gate_spacing_m;
}

std::size_t radials_with_gates(const SweepMoment& moment) {
    return static_cast<std::size_t>(std::count_if(moment.gate_counts.begin(),
                                                  moment.gate_counts.end(),
                                                  [](std::uint16_t gates) { return gates > 0; }));
}

std::size_t most_gates(const SweepMoment& moment) {
    const auto most = std::max_element(moment.gate_counts.begin(), moment.gate_counts.end());
    return most == moment.gate_counts.end() ? 0 : *most;
}

// Returns the number of the first element that the moment's first gate fills. Element 0 has its
// center at `axis_first_m`. The number is negative if the gate begins before element 0. An element
// belongs to the gate if its center is beyond the gate's near edge. So a gate that is as long as
// the spacing of the axis fills one element, at the gate's center.
std::int64_t first_element(std::int64_t axis_first_m, std::int64_t spacing_m,
                           const SweepMoment& moment) {
    const std::int64_t doubled = 2 * (moment.first_gate_m - axis_first_m) - moment.gate_spacing_m;
    const std::int64_t step = 2 * spacing_m;
    const std::int64_t floor = doubled / step - (doubled % step < 0 ? 1 : 0);
    return floor + 1;
}

// An axis with more elements than this means a damaged file. A radial to 460 km has 1840 gates of
// 250 m.
constexpr std::int64_t most_elements = 8192;
constexpr std::int32_t most_repeats = 8;

// Returns all moments of the sweeps that have gates.
std::vector<const SweepMoment*> moments_of(std::span<const level2::Sweep> sweeps) {
    std::vector<const SweepMoment*> moments;
    for (const level2::Sweep& sweep : sweeps) {
        for (const SweepMoment& moment : sweep.moments)
            if (most_gates(moment) > 0) moments.push_back(&moment);
    }
    return moments;
}

// Returns true if the moment's gates fit onto an axis whose elements are the gates of `finest`.
bool fits(const SweepMoment& moment, const SweepMoment& finest) {
    const std::int32_t spacing_m = finest.gate_spacing_m;
    if (spacing_m <= 0 || moment.gate_spacing_m % spacing_m != 0) return false;
    if (moment.gate_spacing_m / spacing_m > most_repeats) return false;
    return moment.gate_spacing_m != spacing_m ||
           (moment.first_gate_m - finest.first_gate_m) % spacing_m == 0;
}

Status check_arrays(const SweepMoment& moment, std::size_t sweep, std::size_t radials) {
    const bool wide = moment.word_size_bits == 16;
    const std::size_t codes = wide ? moment.codes16.size() : moment.codes8.size();
    const auto stride = static_cast<std::size_t>(std::max(moment.gate_stride, 0));
    const bool fits = (wide || moment.word_size_bits == 8) &&
                      moment.gate_counts.size() == radials && codes == radials * stride &&
                      std::all_of(moment.gate_counts.begin(), moment.gate_counts.end(),
                                  [&](std::uint16_t gates) { return gates <= stride; });
    if (fits) return {};
    return fail(ErrorCode::bad_argument, "sweep {}: the arrays of {} do not fit its {} radials",
                sweep, level2::moment_name(moment.moment), radials);
}

// Puts the gates of a sweep into the field of their kind, or into a new field. If a sweep holds one
// kind twice, the second goes into another field.
void add(CfradialLayout& layout, const SweepMoment& moment, std::size_t sweep,
         std::size_t sweep_count, bool one_axis) {
    const std::size_t radials = radials_with_gates(moment);
    if (radials == 0) return;
    auto field = std::find_if(layout.fields.begin(), layout.fields.end(), [&](const auto& made) {
        return made.sweeps[sweep] == nullptr && same_packing(*made.kind, moment) &&
               (one_axis || same_geometry(*made.kind, moment));
    });
    if (field == layout.fields.end()) {
        field = layout.fields.emplace(field);
        field->sweeps.resize(sweep_count);
        field->kind = &moment;
    }
    field->sweeps[sweep] = &moment;
    field->radials += radials;
}

void order_and_name(std::vector<CfradialField>& fields, FieldNames (*names)(level2::Moment)) {
    std::stable_sort(fields.begin(), fields.end(), [](const auto& a, const auto& b) {
        if (a.kind->moment != b.kind->moment) return a.kind->moment < b.kind->moment;
        return a.radials > b.radials;
    });
    int number = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const level2::Moment moment = fields[i].kind->moment;
        const bool further = i > 0 && fields[i - 1].kind->moment == moment;
        number = further ? number + 1 : 1;
        const FieldNames named = names(moment);
        fields[i].name = named.name;
        fields[i].standard_name = named.standard_name;
        if (further) fields[i].name += fmt::format("_{}", number);
    }
}

void find_axes(CfradialLayout& layout) {
    for (CfradialField& field : layout.fields) {
        const SweepMoment& kind = *field.kind;
        auto axis = std::find_if(layout.axes.begin(), layout.axes.end(), [&](const auto& made) {
            return made.first_gate_m == kind.first_gate_m &&
                   made.gate_spacing_m == kind.gate_spacing_m;
        });
        if (axis == layout.axes.end()) {
            const std::size_t number = layout.axes.size() + 1;
            axis =
                layout.axes.insert(axis, {number == 1 ? "range" : fmt::format("range_{}", number),
                                          kind.first_gate_m, kind.gate_spacing_m, 0});
        }
        for (const SweepMoment* moment : field.sweeps)
            if (moment != nullptr) axis->gates = std::max(axis->gates, most_gates(*moment));
        field.axis = static_cast<std::size_t>(axis - layout.axes.begin());
    }
    if (layout.axes.empty()) layout.axes.push_back({"range", 0, 0, 0});
}

}  // namespace

FieldNames names_in_cfradial_1(level2::Moment moment) {
    const level2::MomentFacts& facts = level2::facts_of(moment);
    return {facts.netcdf.variable.empty() ? facts.name : facts.netcdf.variable,
            facts.netcdf.cfradial};
}

GatePlacement place_gates(const RangeAxis& axis, const level2::SweepMoment& moment) {
    // The gates are damaged, and the axis was made for them.
    if (axis.gate_spacing_m <= 0) return {};
    const std::int64_t first = first_element(axis.first_gate_m, axis.gate_spacing_m, moment);
    return {static_cast<std::size_t>(first),
            static_cast<std::size_t>(moment.gate_spacing_m / axis.gate_spacing_m)};
}

std::optional<RangeAxis> common_axis(std::span<const level2::Sweep> sweeps) {
    const std::vector<const SweepMoment*> moments = moments_of(sweeps);
    const auto finest = std::min_element(
        moments.begin(), moments.end(),
        [](const auto* a, const auto* b) { return a->gate_spacing_m < b->gate_spacing_m; });
    if (finest == moments.end()) return std::nullopt;
    std::int64_t begin = 0;
    std::int64_t end = 0;
    for (const SweepMoment* moment : moments) {
        if (!fits(*moment, **finest)) return std::nullopt;
        const std::int64_t first =
            first_element((*finest)->first_gate_m, (*finest)->gate_spacing_m, *moment);
        const std::int64_t repeats = moment->gate_spacing_m / (*finest)->gate_spacing_m;
        begin = std::min(begin, first);
        end = std::max(end, first + repeats * static_cast<std::int64_t>(most_gates(*moment)));
    }
    if (end - begin > most_elements) return std::nullopt;
    const std::int64_t first_m = (*finest)->first_gate_m + begin * (*finest)->gate_spacing_m;
    return RangeAxis{"range", static_cast<std::int32_t>(first_m), (*finest)->gate_spacing_m,
                     static_cast<std::size_t>(end - begin)};
}

Status check_sweeps(std::span<const level2::Sweep> sweeps) {
    for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
        const level2::Sweep& from = sweeps[sweep];
        if (from.radials.empty()) {
            return fail(ErrorCode::bad_argument, "sweep {} has no radials", sweep);
        }
        for (const SweepMoment& moment : from.moments) {
            if (auto good = check_arrays(moment, sweep, from.radials.size()); !good) return good;
        }
    }
    return {};
}

Result<CfradialLayout> lay_out(std::span<const level2::Sweep> sweeps, RangeAxes ranges,
                               FieldNames (*names)(level2::Moment)) {
    if (auto good = check_sweeps(sweeps); !good) return pass_on(good);
    CfradialLayout layout;
    const auto axis = ranges == RangeAxes::one_if_possible ? common_axis(sweeps) : std::nullopt;
    for (std::size_t sweep = 0; sweep < sweeps.size(); ++sweep) {
        layout.first_radials.push_back(layout.radials);
        layout.radials += sweeps[sweep].radials.size();
        for (const SweepMoment& moment : sweeps[sweep].moments)
            add(layout, moment, sweep, sweeps.size(), axis.has_value());
        if (layout.fields.size() > most_cfradial_fields) {
            return fail(ErrorCode::unsupported,
                        "more than {} kinds of gates that differ in moment, range, scale or offset",
                        most_cfradial_fields);
        }
    }
    order_and_name(layout.fields, names);
    if (axis) {
        layout.axes = {*axis};  // all fields are on this axis
    } else {
        find_axes(layout);
    }
    return layout;
}

}  // namespace stormcellar::netcdf

#include "export/cfradial_layout.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

namespace stormcellar::netcdf {
namespace {

using level2::SweepMoment;

// Compares bits, so that two scales that are NaN are the same scale.
bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool same_kind(const SweepMoment& a, const SweepMoment& b) {
    return a.moment == b.moment && a.first_gate_m == b.first_gate_m &&
           a.gate_spacing_m == b.gate_spacing_m && a.word_size_bits == b.word_size_bits &&
           same_bits(a.scale, b.scale) && same_bits(a.offset, b.offset);
}

std::size_t radials_with_gates(const SweepMoment& moment) {
    return static_cast<std::size_t>(std::count_if(moment.gate_counts.begin(),
                                                  moment.gate_counts.end(),
                                                  [](std::uint16_t gates) { return gates > 0; }));
}

std::size_t most_gates(const CfradialField& field) {
    std::size_t most = 0;
    for (const SweepMoment* moment : field.sweeps) {
        if (moment == nullptr) continue;
        for (const std::uint16_t gates : moment->gate_counts)
            most = std::max<std::size_t>(most, gates);
    }
    return most;
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

// Puts the gates of a sweep into the field of their kind, or into a new field. A sweep that holds
// one kind twice needs two fields.
void add(CfradialLayout& layout, const SweepMoment& moment, std::size_t sweep,
         std::size_t sweep_count) {
    const std::size_t radials = radials_with_gates(moment);
    if (radials == 0) return;
    auto field = std::find_if(layout.fields.begin(), layout.fields.end(), [&](const auto& made) {
        return made.sweeps[sweep] == nullptr && same_kind(*made.kind, moment);
    });
    if (field == layout.fields.end()) {
        field = layout.fields.emplace(field);
        field->sweeps.resize(sweep_count);
        field->kind = &moment;
    }
    field->sweeps[sweep] = &moment;
    field->radials += radials;
}

void order_and_name(std::vector<CfradialField>& fields) {
    std::stable_sort(fields.begin(), fields.end(), [](const auto& a, const auto& b) {
        if (a.kind->moment != b.kind->moment) return a.kind->moment < b.kind->moment;
        return a.radials > b.radials;
    });
    int number = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const level2::Moment moment = fields[i].kind->moment;
        const bool further = i > 0 && fields[i - 1].kind->moment == moment;
        number = further ? number + 1 : 1;
        fields[i].name = level2::moment_name(moment);
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
        axis->gates = std::max(axis->gates, most_gates(field));
        field.axis = static_cast<std::size_t>(axis - layout.axes.begin());
    }
    if (layout.axes.empty()) layout.axes.push_back({"range", 0, 0, 0});
}

}  // namespace

Result<CfradialLayout> lay_out(const level2::Volume& volume) {
    CfradialLayout layout;
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
        const level2::Sweep& from = volume.sweeps[sweep];
        if (from.radials.empty()) {
            return fail(ErrorCode::bad_argument, "sweep {} has no radials", sweep);
        }
        layout.first_radials.push_back(layout.radials);
        layout.radials += from.radials.size();
        for (const SweepMoment& moment : from.moments) {
            if (auto good = check_arrays(moment, sweep, from.radials.size()); !good) {
                return pass_on(good);
            }
            add(layout, moment, sweep, volume.sweeps.size());
        }
        if (layout.fields.size() > most_cfradial_fields) {
            return fail(ErrorCode::unsupported,
                        "more than {} kinds of gates that differ in moment, range, scale or offset",
                        most_cfradial_fields);
        }
    }
    order_and_name(layout.fields);
    find_axes(layout);
    return layout;
}

}  // namespace stormcellar::netcdf

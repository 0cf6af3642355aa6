// Computes KDP for the sweeps of a volume.
#include "stormcellar/retrieve/kdp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "retrieve/kdp/phase_row.h"
#include "retrieve/kdp/phase_slope.h"
#include "retrieve/quality/gate_field.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr float no_kdp = std::numeric_limits<float>::quiet_NaN();

// Returns the correlation coefficients at the gates of a row of phases; empty without any.
std::vector<float> correlations_at(const GateField& phases, const GateField& correlations,
                                   std::size_t radial) {
    if (correlations.is_empty()) return {};
    std::vector<float> found(phases.gates, no_kdp);
    for (std::size_t gate = 0; gate < phases.gates; ++gate) {
        const std::int32_t there = correlations.gate_at(phases.range_m(gate));
        if (there >= 0) found[gate] = correlations.value(radial, static_cast<std::size_t>(there));
    }
    return found;
}

// Fits the gates up to the last one with a phase, and keeps those that have one.
void fit_radial(const GateField& phases, const GateField& correlations, std::size_t radial,
                SweepKdp& made) {
    const std::uint16_t* codes = phases.row(radial);
    std::size_t gates = phases.gates;
    while (gates > 0 && codes[gates - 1] == 0)
        --gates;
    if (gates == 0) return;
    std::vector<float> values(gates);
    for (std::size_t gate = 0; gate < gates; ++gate)
        values[gate] = phases.value(radial, gate);
    std::vector<float> known = correlations_at(phases, correlations, radial);
    if (!known.empty()) known.resize(gates);
    PhaseRow row = unfold_phases(values, known);
    leave_out_backscatter(row, phases.gate_spacing_m);
    const PhaseSlopes slopes = fit_slopes(row, phases.gate_spacing_m);
    const auto per_gate_both_ways = static_cast<float>(2 * phases.gate_spacing_m / 1000);
    for (std::size_t gate = 0; gate < gates; ++gate) {
        if (codes[gate] == 0) continue;
        const std::size_t at = radial * phases.gates + gate;
        made.deg_per_km[at] = slopes.deg_per_gate[gate] / per_gate_both_ways;
        made.error_deg_per_km[at] = slopes.error[gate] / per_gate_both_ways;
    }
}

}  // namespace

std::vector<SweepKdp> specific_differential_phases(const level2::Volume& volume) {
    std::vector<SweepKdp> all;
    for (std::size_t number = 0; number < volume.sweeps.size(); ++number) {
        const level2::Sweep& sweep = volume.sweeps[number];
        const level2::SweepMoment* rho = sweep.find(Moment::rho);
        const GateField correlations = rho != nullptr ? gate_field(sweep, *rho) : GateField{};
        for (std::size_t moment = 0; moment < sweep.moments.size(); ++moment) {
            if (sweep.moments[moment].moment != Moment::phi) continue;
            const GateField phases = gate_field(sweep, sweep.moments[moment]);
            if (phases.is_empty()) continue;
            SweepKdp made{number, moment, std::vector<float>(phases.codes.size(), no_kdp),
                          std::vector<float>(phases.codes.size(), no_kdp)};
            for (std::size_t radial = 0; radial < phases.radials; ++radial)
                fit_radial(phases, correlations, radial, made);
            all.push_back(std::move(made));
        }
    }
    return all;
}

}  // namespace stormcellar::retrieve

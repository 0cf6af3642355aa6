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

// Computes KDP of one moment of a sweep, radial by radial.
class KdpMaker {
  public:
    // Without correlations, the field is empty.
    KdpMaker(const GateField& phases, const GateField& correlations)
        : phases_(phases), correlations_(correlations), fitter_(phases.gate_spacing_m) {
        if (correlations.is_empty()) return;
        gates_there_.resize(phases.gates);
        for (std::size_t gate = 0; gate < phases.gates; ++gate)
            gates_there_[gate] = correlations.gate_at(phases.range_m(gate));
    }

    // Fits slopes at the gates up to the last gate with a phase, and keeps the slopes of gates with
    // a phase.
    void fit(std::size_t radial, SweepKdp& made) {
        const std::size_t gates = phases_.ends[radial];
        if (gates == 0) return;
        values_.resize(gates);
        for (std::size_t gate = 0; gate < gates; ++gate)
            values_[gate] = phases_.value(radial, gate);
        find_correlations(radial, gates);
        PhaseRow row = unfold_phases(values_, known_);
        const PhaseSlopes& slopes = fitter_.fit(row);
        const auto per_gate_both_ways = static_cast<float>(2 * phases_.gate_spacing_m / 1000);
        const std::uint16_t* codes = phases_.row(radial);
        for (std::size_t gate = 0; gate < gates; ++gate) {
            if (codes[gate] == 0) continue;
            const std::size_t at = radial * phases_.gates + gate;
            made.deg_per_km[at] = slopes.deg_per_gate[gate] / per_gate_both_ways;
            made.error_deg_per_km[at] = slopes.error[gate] / per_gate_both_ways;
        }
    }

  private:
    // Finds the correlation coefficients at the gates. Does nothing if the sweep has no
    // correlations.
    void find_correlations(std::size_t radial, std::size_t gates) {
        if (correlations_.is_empty()) return;
        known_.resize(gates);
        for (std::size_t gate = 0; gate < gates; ++gate) {
            const std::int32_t there = gates_there_[gate];
            known_[gate] =
                there >= 0 ? correlations_.value(radial, static_cast<std::size_t>(there)) : no_kdp;
        }
    }

    const GateField& phases_;
    const GateField& correlations_;
    SlopeFitter fitter_;
    std::vector<std::int32_t> gates_there_;  // of the correlations; -1 for none
    std::vector<float> values_, known_;      // of one radial
};

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
            KdpMaker maker(phases, correlations);
            for (std::size_t radial = 0; radial < phases.radials; ++radial)
                maker.fit(radial, made);
            all.push_back(std::move(made));
        }
    }
    return all;
}

}  // namespace stormcellar::retrieve

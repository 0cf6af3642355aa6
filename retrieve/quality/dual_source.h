// retrieve/quality/dual_source.h -- results that a sweep without dual polarization takes from a
// sweep of the same angle that has dual polarization.
//
// Threads   Pure functions.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "retrieve/quality/gate_field.h"
#include "retrieve/sweeps/nearest_sweep.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

[[nodiscard]] bool has_dual_polarization(const level2::Sweep& sweep);

// Returns the sweep with dual polarization from which another sweep takes results.
[[nodiscard]] std::optional<std::size_t> dual_source(const level2::Volume& volume,
                                                     std::size_t sweep);

// Returns, for each gate of `field`, a moment of the sweep `to`, the value at the nearest gate of
// `there`, a moment of the sweep `from`. Gates without echo, and gates that have no nearest gate,
// get `none`.
template <class Value>
std::vector<Value> taken_values(const GateField& field, const level2::Sweep& to,
                                const level2::SweepMoment& there, const level2::Sweep& from,
                                const std::vector<Value>& values, Value none) {
    const auto stride = static_cast<std::size_t>(there.gate_stride);
    std::vector<std::size_t> gates(field.gates);  // stride: outside
    for (std::size_t gate = 0; gate < gates.size(); ++gate) {
        const auto other =
            std::llround((field.range_m(gate) - there.first_gate_m) / there.gate_spacing_m);
        gates[gate] =
            other >= 0 && other < there.gate_stride ? static_cast<std::size_t>(other) : stride;
    }
    const std::vector<std::int32_t> radials = nearest_radials(azimuths_of(to), from);
    std::vector<Value> taken(field.codes.size(), none);
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        if (radials[radial] < 0) continue;
        const Value* row = values.data() + static_cast<std::size_t>(radials[radial]) * stride;
        const std::uint16_t* codes = field.row(radial);
        for (std::size_t gate = 0; gate < field.gates; ++gate)
            if (codes[gate] != 0 && gates[gate] != stride)
                taken[radial * field.gates + gate] = row[gates[gate]];
    }
    return taken;
}

}  // namespace stormcellar::retrieve

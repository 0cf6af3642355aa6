#include "tests/retrieve/echo_volume.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "stormcellar/grid/beam_geometry.h"
#include "tests/retrieve/empty_moment.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

void set_value(level2::SweepMoment& moment, std::size_t at, float value) {
    if (std::isnan(value)) return;
    const long code = std::lround(value * moment.scale + moment.offset);
    moment.codes16[at] = static_cast<std::uint16_t>(std::max(2L, code));
}

level2::Sweep echo_sweep(const EchoVolumeSpec& spec, double elevation_deg,
                         const std::function<EchoGate(const EchoPlace&)>& gate_at) {
    using namespace std::chrono;
    level2::Sweep sweep;
    for (int i = 0; i < spec.radials; ++i) {
        level2::Radial& radial = sweep.radials.emplace_back();
        radial.time = sys_days{year{1999} / 5 / 4} + seconds{34};
        radial.azimuth_deg =
            0.25F + 360.0F * static_cast<float>(i) / static_cast<float>(spec.radials);
        radial.elevation_deg = static_cast<float>(elevation_deg);
        radial.nyquist_mps = 26;
    }
    const GateLayout layout = {spec.radials, spec.gates, spec.gate_spacing_m, spec.gate_spacing_m};
    for (const Moment kind : {Moment::ref, Moment::vel, Moment::sw})
        sweep.moments.push_back(empty_moment(layout, kind));
    if (spec.has_dual)
        for (const Moment kind : {Moment::zdr, Moment::phi, Moment::rho})
            sweep.moments.push_back(empty_moment(layout, kind));
    const grid::BeamGeometry beam(40, 0);
    std::size_t at = 0;
    for (const level2::Radial& radial : sweep.radials)
        for (int i = 0; i < spec.gates; ++i, ++at) {
            const double range = sweep.moments[0].range_m(i);
            const EchoGate gate = gate_at({elevation_deg, static_cast<double>(radial.azimuth_deg),
                                           range, beam.forward({range, elevation_deg}).height_m});
            if (std::isnan(gate.reflectivity_dbz)) continue;
            set_value(sweep.moments[0], at, gate.reflectivity_dbz);
            set_value(sweep.moments[1], at, gate.velocity_mps);
            set_value(sweep.moments[2], at, gate.width_mps);
            if (!spec.has_dual) continue;
            set_value(sweep.moments[3], at, 1);
            set_value(sweep.moments[4], at, gate.phase_deg);
            set_value(sweep.moments[5], at, gate.correlation);
        }
    return sweep;
}

}  // namespace

level2::Volume echo_volume(const EchoVolumeSpec& spec,
                           const std::function<EchoGate(const EchoPlace&)>& gate) {
    level2::Volume volume;
    volume.station = "KTLX";
    for (const double elevation : spec.elevations_deg)
        volume.sweeps.push_back(echo_sweep(spec, elevation, gate));
    return volume;
}

}  // namespace stormcellar::retrieve

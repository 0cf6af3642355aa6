// tests/retrieve/rankine_vortex.h -- a vortex whose azimuthal shear, as a beam, a median and the
// kernel smooth it, is known.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/degree.h"
#include "tests/retrieve/folded_volume.h"
#include "tests/retrieve/velocity_sweep.h"

namespace stormcellar::retrieve {

// A Rankine vortex: it turns like a solid body up to `radius_m`, and more slowly outside.
struct Vortex {
    double range_m, radius_m, fastest_mps, nyquist_mps;
    int radials;
    bool is_folded;  // after the smoothing
    static constexpr double azimuth_deg = 255;

    // Returns the velocity away from the radar at a point.
    [[nodiscard]] double at(double point_deg, double point_m) const {
        const double turn = turn_deg(azimuth_deg, point_deg) * degree;
        const double across = point_m * std::sin(turn);
        const double along = point_m * std::cos(turn) - range_m;
        const double distance_m = std::max(std::hypot(across, along), 1.0);
        const double speed_mps = distance_m < radius_m ? fastest_mps * distance_m / radius_m
                                                       : fastest_mps * radius_m / distance_m;
        // The velocity is across / distance along the center's azimuth, and -along / distance
        // across it.
        return speed_mps / distance_m * (across * std::cos(turn) - along * std::sin(turn));
    }
    // Returns the mean over a beam with a Gaussian pattern and over a gate, by a sum of
    // steps x steps points.
    [[nodiscard]] double smoothed(double beam_deg, double gate_m, int steps) const {
        constexpr double half_power_deg = 0.93, gate_length_m = 250, reach_deg = 1.2;
        double sum = 0, weights = 0;
        for (int i = 0; i < steps; ++i) {
            const double off_deg = reach_deg * ((2 * i + 1.0) / steps - 1);
            // The pattern counts twice: on the way out and on the way back.
            const double weight =
                std::exp(-8 * std::log(2) * std::pow(off_deg / half_power_deg, 2));
            for (int k = 0; k < steps; ++k) {
                const double off_m = gate_length_m / 2 * ((2 * k + 1.0) / steps - 1);
                sum += weight * at(beam_deg + off_deg, gate_m + off_m);
                weights += weight;
            }
        }
        return sum / weights;
    }
    // Returns the velocity after the median of super-resolution.
    [[nodiscard]] double filtered(double gate_deg, double gate_m) const {
        constexpr int fine = 15;
        if (radials < 720) return smoothed(gate_deg, gate_m, fine);
        std::vector<double> nine;
        for (const double off_deg : {-0.5, 0.0, 0.5})
            for (const double off_m : {-250.0, 0.0, 250.0})
                nine.push_back(smoothed(gate_deg + off_deg, gate_m + off_m, fine));
        std::ranges::sort(nine);
        return nine[4];
    }
    // Returns the slope across the beam that a kernel of 2500 m x 750 m finds at a gate, from
    // sums over the kernel's gates.
    [[nodiscard]] double expected(double gate_deg, double gate_m) const {
        const double step_deg = 360.0 / radials;
        const double reach_deg = std::max(1250 / gate_m / degree, 1.5 * step_deg);
        double top = 0, bottom = 0;
        for (int away = -60; away <= 60; ++away) {
            if (std::abs(away * step_deg) > reach_deg) continue;
            for (const double near_m : {gate_m - 250, gate_m, gate_m + 250}) {
                const double angle = away * step_deg * degree;
                top += angle * filtered(gate_deg + away * step_deg, near_m);
                bottom += angle * angle * gate_m;
            }
        }
        return top / bottom;
    }
};

// Returns a volume of two sweeps whose beams smooth the vortex within 5 km of its center.
[[nodiscard]] inline FoldedVolume fold(const Vortex& vortex) {
    FoldedSpec spec;
    spec.nyquist_mps = vortex.nyquist_mps;
    spec.elevations_deg = {0.5, 1.5};
    spec.radials = vortex.radials;
    spec.gates = static_cast<int>((vortex.range_m + 15e3) / 250);
    spec.noise_mps = 0;
    spec.missing = 0;
    return fold(spec, [&](double azimuth_deg, double range_m, double, double) {
        const double across_m =
            range_m * std::abs(turn_deg(Vortex::azimuth_deg, azimuth_deg)) * degree;
        const bool is_near = across_m < 5000 && std::abs(range_m - vortex.range_m) < 5000;
        return is_near ? vortex.smoothed(azimuth_deg, range_m, 7) : vortex.at(azimuth_deg, range_m);
    });
}

// Calls visit(index of the gate in its sweep, expected shear) for the 5 x 5 gates around the
// center.
template <class Visit>
void for_gates_around(const Vortex& vortex, std::size_t gates, Visit visit) {
    const auto gate = static_cast<std::size_t>((vortex.range_m - 2000) / 250);
    const auto radial = static_cast<std::size_t>(Vortex::azimuth_deg * vortex.radials / 360);
    for (std::size_t row = radial - 2; row <= radial + 2; ++row)
        for (std::size_t column = gate - 2; column <= gate + 2; ++column)
            visit(row * gates + column,
                  vortex.expected((static_cast<double>(row) + 0.5) * 360 / vortex.radials,
                                  2000 + 250 * static_cast<double>(column)));
}

}  // namespace stormcellar::retrieve

// tests/grid/quality_chart.h -- quality figures of a grid: how wide a point becomes, how far it
// moves, how steep an edge stays, how much of a wave is left, and whether reflectivity is
// conserved.
//
// A simulated radar (synth/observe.h, VCP 212) observes one small feature at a range. Its gates are
// points, or means over the beam and the pulse of a WSR-88D. The grid about the feature is compared
// with the truth in closed form, so the charts contain the effects of gate and grid together.
// "Along" and "across" refer to the beam. Cells are 1 km wide and 500 m high. Their lattice is
// shifted by parts of a cell from chart to chart, so that no feature is at the center of a cell by
// chance, and charts are means over the shifts.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include "stormcellar/grid/gridder.h"
#include "synth/synth_scene.h"

namespace stormcellar::grid {

// A feature as its radar observes it.
struct Observed {
    synth::Scene scene;
    level2::Volume volume;
    double range_m = 0;
};
// sampled at the center of the gate, or averaged over beam and pulse
enum class Gates { of_points, of_beams };

// A Gaussian of 1.1 km between half powers, 50 dBZ, from the ground to above 4 km.
[[nodiscard]] Observed observe_point(double range_m, Gates gates);
// A plateau of 40 dBZ, 40 km by 40 km, whose near side is at the range.
[[nodiscard]] Observed observe_edge(double range_m, Gates gates);
// 30 +- 10 dBZ along or across the beam.
[[nodiscard]] Observed observe_wave(double range_m, Gates gates, double length_m, bool across);

// Widths are 2.355 deviations of the distribution of Z, which is the width of a Gaussian between
// half powers.
struct PointChart {
    double along_km = 0, across_km = 0, height_km = 0;
    double true_along_km = 0, true_across_km = 0, true_height_km = 0;
    double shift_km = 0;         // horizontal, of the centroid of Z; root of the mean square
    double shift_height_km = 0;  // mean
    double peak_dbz = 0;         // the largest value
    // Over the cells that are seen: total Z, and volume of 20 dBZ and more, divided by those of the
    // truth.
    double total_z_ratio = 0, echo_volume_ratio = 0;
};
[[nodiscard]] PointChart point_chart(const Observed& observed, const grid::Method& method);

// Of the near side, in Z: the distance from 10 % to 90 % of the plateau, and how far beyond its
// true place 50 % is.
struct EdgeChart {
    double rise_km = 0;
    double shift_km = 0;
};
[[nodiscard]] EdgeChart edge_chart(const Observed& observed, const grid::Method& method);

// In dBZ, fitted at the length of the wave itself.
struct WaveChart {
    double amplitude_ratio = 0;
    double shift_km = 0;  // of the phase
};
[[nodiscard]] WaveChart wave_chart(const Observed& observed, const grid::Method& method);

}  // namespace stormcellar::grid

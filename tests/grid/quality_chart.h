// tests/grid/quality_chart.h -- quality figures of a grid: the width and the shift of a point, the
// steepness of an edge, how much of a wave remains, and whether reflectivity is conserved.
//
// A simulated radar (synth/observe.h, VCP 212) observes one small feature at a range. The radar's
// gates are points, or means over the beam and the pulse of a WSR-88D. The grid about the feature
// is compared with the truth in closed form, so the charts contain the effects of the gates and of
// the grid. "Along" and "across" refer to the beam. Cells are 1 km wide and 500 m high. Their
// lattice is shifted by parts of a cell from chart to chart, so that no feature is at the center of
// a cell by chance. Charts are means over the shifts.
//
// Threads   Pure functions.
#pragma once

#include "stormcellar/grid/gridder.h"
#include "synth/synth_scene.h"

namespace stormcellar::grid {

// A feature, and the volume in which its radar observes it.
struct Observed {
    synth::Scene scene;
    level2::Volume volume;
    double range_m = 0;
};
// sampled at the center of the gate, or averaged over beam and pulse
enum class Gates { of_points, of_beams };

// Observes a Gaussian of 1.1 km between half powers, 50 dBZ, from the ground to above 4 km.
[[nodiscard]] Observed observe_point(double range_m, Gates gates);
// Observes a plateau of 40 dBZ, 40 km by 40 km, whose near side is at the range.
[[nodiscard]] Observed observe_edge(double range_m, Gates gates);
// Observes a wave of 30 +- 10 dBZ along or across the beam.
[[nodiscard]] Observed observe_wave(double range_m, Gates gates, double length_m, bool across);

// The chart of a point. Widths are 2.355 standard deviations of the distribution of Z, the width of
// a Gaussian between half powers.
struct PointChart {
    double along_km = 0, across_km = 0, height_km = 0;
    double true_along_km = 0, true_across_km = 0, true_height_km = 0;
    double shift_km = 0;         // horizontal shift of the centroid of Z; root of the mean square
    double shift_height_km = 0;  // mean vertical shift
    double peak_dbz = 0;         // the largest value
    // Over the cells that are seen: total Z, and the volume of 20 dBZ and more, each divided by the
    // truth.
    double total_z_ratio = 0, echo_volume_ratio = 0;
};
[[nodiscard]] PointChart point_chart(const Observed& observed, const grid::Method& method);

// The chart of the plateau's near side, across which the mean Z rises to the plateau's Z. The rise
// is the distance over which the mean Z grows from 10 % to 90 % of the plateau's Z. The shift says
// how far beyond the true edge the mean Z reaches 50 %.
struct EdgeChart {
    double rise_km = 0;
    double shift_km = 0;
};
[[nodiscard]] EdgeChart edge_chart(const Observed& observed, const grid::Method& method);

// The chart of a wave in dBZ, fitted at the true length of the wave.
struct WaveChart {
    double amplitude_ratio = 0;
    double shift_km = 0;  // shift of the phase
};
[[nodiscard]] WaveChart wave_chart(const Observed& observed, const grid::Method& method);

}  // namespace stormcellar::grid

// bench/quality_chart.h -- what experts ask of a grid: how wide a point becomes, how far it moves,
// how steep an edge stays, how much of a wave is left, and whether reflectivity is conserved.
//
// A simulated radar (synth/observe.h, VCP 212) observes one small feature at a range, its gates
// points or means over the beam and the pulse of a WSR-88D; the grid about it is compared with the
// truth in closed form, so the charts hold gate and grid together. "Along" and "across" are those
// of the beam. Cells are 1 km wide and 500 m high; their lattice is shifted by parts of a cell from
// chart to chart, so that no feature stands at a cell's center by luck, and charts are means over
// the shifts.
// Threads: pure functions.
#pragma once

#include "stormcellar/grid/gridder.h"
#include "synth/scene.h"

namespace stormcellar::bench {

// A feature as its radar has it.
struct Observed {
    synth::Scene scene;
    level2::Volume volume;
    double range_m = 0;
};
enum class Gates { of_points, of_beams };  // sampled at the gate's center, or over beam and pulse

// A Gaussian of 1.1 km between half powers, 50 dBZ, from the ground to above 4 km.
[[nodiscard]] Observed observe_point(double range_m, Gates gates);
// A plateau of 40 dBZ, 40 km by 40 km, whose near side stands at the range.
[[nodiscard]] Observed observe_edge(double range_m, Gates gates);
// 30 +- 10 dBZ along or across the beam.
[[nodiscard]] Observed observe_wave(double range_m, Gates gates, double length_m, bool across);

// Widths are 2.355 deviations of the distribution of Z: those between half powers of a Gaussian.
struct PointChart {
    double along_km = 0, across_km = 0, height_km = 0;
    double true_along_km = 0, true_across_km = 0, true_height_km = 0;
    double shift_km = 0;         // horizontally, of the centroid of Z; root of the mean square
    double shift_height_km = 0;  // mean
    double peak_dbz = 0;         // the largest value
    // Over the cells that are seen: total Z and volume of 20 dBZ and more, by those of the truth.
    double total_z_ratio = 0, echo_volume_ratio = 0;
};
[[nodiscard]] PointChart point_chart(const Observed& observed, const grid::Method& method);

// Of the near side, in Z: from 10 % to 90 % of the plateau, and how far beyond its place 50 % lies.
struct EdgeChart {
    double rise_km = 0;
    double shift_km = 0;
};
[[nodiscard]] EdgeChart edge_chart(const Observed& observed, const grid::Method& method);

// In dBZ, fitted at the wave's own length.
struct WaveChart {
    double amplitude_ratio = 0;
    double shift_km = 0;  // of the phase
};
[[nodiscard]] WaveChart wave_chart(const Observed& observed, const grid::Method& method);

}  // namespace stormcellar::bench

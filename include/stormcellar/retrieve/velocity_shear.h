// stormcellar/retrieve/velocity_shear.h -- azimuthal shear and radial divergence of velocity
// sweeps, their maxima in layers and over time, and a list of the strongest maxima.
//
// Method    A plane is fitted by least squares to the unfolded velocities of the gates around each
//           gate. Its slope along the azimuth is the azimuthal shear, and its slope along the range
//           is the radial divergence. The kernel has a constant size in meters, so it has fewer
//           radials at longer ranges. In sweeps of super-resolution, a median of 3 x 3 gates comes
//           before the fit, as in MRMS. The slope along the azimuth is fitted against the sine of
//           the angle, and then divided by the distance of the gate from the radar. So a rotation
//           like a solid body is exact.
// Sign      Azimuths are clockwise. Azimuthal shear is positive where the velocity away from the
//           radar grows clockwise: counterclockwise rotation, which is cyclonic in the northern
//           hemisphere. It is half the vertical vorticity of a rotation like a solid body. Radial
//           divergence is positive where the velocity grows with range; it is half the horizontal
//           divergence if the wind spreads alike in all directions.
// Units     s^-1, meters, degrees. Distances are horizontal. Each velocity counts as that of a
//           horizontal wind: V / cos(elevation). There is no terrain model, so all heights are
//           above the antenna, not above the ground below the beam.
// Source    Smith and Elmore (2004); Mahalik et al. (2019), Wea. Forecasting 34, 415. The layers,
//           the median and the size of the kernel follow MRMS (Smith et al. 2016). The standard
//           error is that of a plane fitted by least squares.
// Error     The standard error comes from the distances of the unfiltered velocities from the
//           plane, which also grow where the wind is no plane. It is at least the error that
//           rounding to the step of the codes causes.
// Accuracy  tests/retrieve enforces each line in velocity_shear_test.cpp, plane_fit_test.cpp or
//           shear_layer_test.cpp.
//             solid rotation, linear divergence  2e-5 of the value and the rounding of the codes
//             Rankine vortices                   5 % of the vortex after smoothing by beam, median
//                                                and kernel, for ranges of 20 to 100 km, radii of 1
//                                                to 4 km and Nyquist velocities of 8 to 33 m/s
//             standard error, noise alone        5 % of the spread of the values; after a median,
//                                                twice that spread. 90 % of the values are
//                                                within two standard errors of 0
//             Moore, 1999                        the largest low-level shear is within 1.5 km of
//                                                the tornado
// Not covered  A uniform wind of v m/s across the beam adds v / range to the azimuthal shear. Noise
//           that is alike in adjacent gates (overlapping radials of 0.5 degrees) makes the true
//           error larger. Vortices narrower than the kernel or the beam read low, so values fall
//           with range. Clutter and wrong fold numbers give false shear of up to 0.06 s^-1.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// Names the sweeps whose velocities pass a median of 3 x 3 gates before the fit. The median removes
// speckle, but it also wipes out small vortices if radials are 1 degree apart: at Moore it lowers
// the largest shear from 0.041 to 0.016 s^-1 and moves the place of that shear by 1.5 km.
enum class MedianFilter : std::uint8_t { off, super_resolution, always };

struct ShearOptions {
    // Size of the kernel. It has at least the gates next to the gate, and at most the radials
    // within 15 degrees.
    double kernel_azimuth_m = 2500, kernel_range_m = 750;
    // Share of the kernel's gates that must have a velocity whose fold number is certain.
    double least_share = 0.5;
    MedianFilter median = MedianFilter::super_resolution;  // radials up to 0.75 degrees apart
};

// Shear of one velocity moment of one sweep.
struct SweepShear {
    std::size_t sweep = 0;   // index in the volume
    std::size_t moment = 0;  // index in the sweep
    double elevation_deg = 0;
    // Rows as in the moment: radials x gate_stride. All numbers of a gate are 0 unless it is
    // fitted.
    std::vector<std::uint8_t> is_fitted;
    std::vector<float> azimuthal_per_s, azimuthal_error_per_s;
    std::vector<float> divergence_per_s, divergence_error_per_s;
};

// Computes the shear of the sweep that `folds` names. Leaves out ambiguous gates, gates nearer than
// 1 km, and radials whose Nyquist velocity is unknown, which cannot be unfolded. Returns
// bad_argument if the fold numbers are not those of a velocity moment of the volume, or if an
// option makes no sense.
[[nodiscard]] Result<SweepShear> sweep_shear(const level2::Volume& volume, const SweepFolds& folds,
                                             const ShearOptions& options = {});

// Heights above the antenna; the bottom belongs to the layer.
struct LayerBounds {
    double bottom_m = 0, top_m = 2000;
    bool operator==(const LayerBounds&) const = default;
};
inline constexpr LayerBounds low_level{0, 2000}, mid_level{3000, 6000};

// The largest azimuthal shear in a layer over one place.
struct ShearCell {
    float azimuthal_per_s = 0, error_per_s = 0;  // 0 unless the status is `value`
    float height_m = 0;                          // of the beam's center above the antenna
    // value         some gate was fitted
    // no_echo       a beam passed through the layer, and no gate had enough velocities around it
    // range_folded  as no_echo, but all beams met echo from beyond the unambiguous range
    // not_seen      no beam passed through the layer, or all gates there are ambiguous
    grid::CellStatus status = grid::CellStatus::not_seen;
    UtcTime time;  // of the radial
};

// Ranks the states of a cell: value before no echo, before range folded and ambiguous, before not
// seen. Where several sweeps or volumes show a cell, the highest rank decides.
[[nodiscard]] int knowledge(grid::CellStatus status);

// A layer about the radar. Cell (azimuth a, arc b) is centered (a + 1/2) azimuth_step_deg from
// north and (b + 1/2) arc_step_m from the radar, and takes the nearest gate of each sweep, if the
// center of that gate is within the layer.
struct ShearLayer {
    static constexpr std::size_t azimuths = 720, arcs = 920;
    static constexpr double azimuth_step_deg = 0.5, arc_step_m = 250;

    std::string station;
    LayerBounds bounds;
    std::vector<ShearCell> cells;  // azimuths x arcs, or empty

    [[nodiscard]] const ShearCell& at(std::size_t azimuth, std::size_t arc) const {
        return cells[azimuth * arcs + arc];
    }
    [[nodiscard]] static grid::PolarPoint center(std::size_t azimuth, std::size_t arc) {
        return {(static_cast<double>(azimuth) + 0.5) * azimuth_step_deg,
                (static_cast<double>(arc) + 0.5) * arc_step_m};
    }
};

// Computes layers from all sweeps of a volume, in the order of `bounds`. Returns the errors of
// sweep_shear(), and bad_argument for bounds that are not in order.
[[nodiscard]] Result<std::vector<ShearLayer>> shear_layers(const level2::Volume& volume,
                                                           const Dealiased& dealiased,
                                                           std::span<const LayerBounds> bounds,
                                                           const ShearOptions& options = {});

// Adds a later layer of the same station to a rotation track, which keeps the largest azimuthal
// shear of each cell. An empty track becomes the layer. Returns bad_argument if the station or the
// bounds differ.
[[nodiscard]] Result<void> add_to_track(ShearLayer& track, const ShearLayer& layer);

struct ShearMaximum {
    grid::GeoPoint position;  // of the center of the cell
    grid::PolarPoint from_radar;
    float azimuthal_per_s = 0, error_per_s = 0;
    float height_m = 0;  // above the antenna
    UtcTime time;
};

struct MaximaOptions {
    std::size_t most = 10;
    double least_separation_m = 5000;
    // A maximum must be at least this many standard errors.
    double least_errors = 3;
    // Nearer maxima are left out, because the mean wind across the beam dominates them.
    double nearest_m = 5000;
};

// Lists the strongest cyclonic maxima of a layer or track, the strongest first. A maximum nearer
// than the least separation to a stronger maximum is left out. `radar` is the antenna's position.
[[nodiscard]] std::vector<ShearMaximum> strongest_maxima(const ShearLayer& layer,
                                                         grid::GeoPoint radar,
                                                         const MaximaOptions& options = {});

}  // namespace stormcellar::retrieve

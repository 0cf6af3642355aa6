#include "tests/retrieve/analytic_hurricane.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {

double AnalyticHurricane::tangential_mps(double at_m) const {
    return at_m < radius_m ? maximum_mps * at_m / radius_m
                           : maximum_mps * std::pow(radius_m / at_m, decay);
}

double AnalyticHurricane::along_beam_mps(double x_m, double y_m) const {
    const double x = x_m - center.x_m, y = y_m - center.y_m;
    const double radius = std::max(std::hypot(x, y), 1.0);
    const double azimuth = std::atan2(x, y);
    const double mean = tangential_mps(radius);
    const double tangential =
        rotation * mean * (1 + wave1 * std::cos(azimuth - wave1_azimuth_deg * degree));
    const double outward = -inflow_mps * mean / maximum_mps;
    const double u = east_mps + (outward * x - tangential * y) / radius;
    const double v = north_mps + (outward * y + tangential * x) / radius;
    return (u * x_m + v * y_m) / std::max(std::hypot(x_m, y_m), 1.0);
}

FoldedVolume hurricane_volume(const AnalyticHurricane& hurricane, double nyquist_mps) {
    FoldedSpec spec;
    spec.nyquist_mps = nyquist_mps;
    spec.elevations_deg = {0.5};
    spec.radials = 720;
    spec.gates = 912;
    const grid::BeamGeometry beam(28, 0);
    FoldedVolume folded = fold(spec, [&](double azimuth_deg, double range_m, double elevation_deg,
                                         double /*height*/) {
        const grid::PlanePoint place =
            grid::SiteFrame::to_plane({azimuth_deg, beam.forward({range_m, elevation_deg}).arc_m});
        return hurricane.along_beam_mps(place.x_m, place.y_m) * std::cos(elevation_deg * degree);
    });
    folded.volume.block.emplace();
    folded.volume.block->latitude_deg = hurricane.rotation < 0 ? -28.0F : 28.0F;
    folded.volume.block->longitude_deg = -90;
    return folded;
}

}  // namespace stormcellar::retrieve

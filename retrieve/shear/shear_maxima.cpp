#include <algorithm>
#include <cmath>

#include "stormcellar/retrieve/velocity_shear.h"

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

struct PeakCell {
    std::size_t azimuth, arc;
    float azimuthal_per_s;
};

// Returns true if no neighboring cell has a larger shear.
bool is_peak(const ShearLayer& layer, std::size_t azimuth, std::size_t arc) {
    const float own = layer.at(azimuth, arc).azimuthal_per_s;
    const std::size_t last_arc = std::min(arc + 1, ShearLayer::arcs - 1);
    for (std::size_t turn = 0; turn < 3; ++turn) {
        const std::size_t a = (azimuth + ShearLayer::azimuths - 1 + turn) % ShearLayer::azimuths;
        for (std::size_t b = arc == 0 ? 0 : arc - 1; b <= last_arc; ++b)
            if (layer.at(a, b).status == CellStatus::value && layer.at(a, b).azimuthal_per_s > own)
                return false;
    }
    return true;
}

std::vector<PeakCell> peaks_of(const ShearLayer& layer, const MaximaOptions& options) {
    std::vector<PeakCell> peaks;
    for (std::size_t azimuth = 0; azimuth < ShearLayer::azimuths; ++azimuth) {
        for (std::size_t arc = 0; arc < ShearLayer::arcs; ++arc) {
            const ShearCell& cell = layer.at(azimuth, arc);
            const auto shear = static_cast<double>(cell.azimuthal_per_s);
            if (cell.status == CellStatus::value && shear > 0 &&
                shear >= options.least_errors * static_cast<double>(cell.error_per_s) &&
                ShearLayer::center(azimuth, arc).arc_m >= options.nearest_m &&
                is_peak(layer, azimuth, arc))
                peaks.push_back({azimuth, arc, cell.azimuthal_per_s});
        }
    }
    std::ranges::stable_sort(peaks, std::greater<>{}, &PeakCell::azimuthal_per_s);
    return peaks;
}

double separation_m(grid::PolarPoint a, grid::PolarPoint b) {
    const grid::PlanePoint from = grid::SiteFrame::to_plane(a), to = grid::SiteFrame::to_plane(b);
    return std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
}

}  // namespace

std::vector<ShearMaximum> strongest_maxima(const ShearLayer& layer, grid::GeoPoint radar,
                                           const MaximaOptions& options) {
    std::vector<ShearMaximum> maxima;
    if (layer.cells.empty()) return maxima;
    const grid::SiteFrame frame(radar.latitude_deg, radar.longitude_deg);
    for (const PeakCell& peak : peaks_of(layer, options)) {
        if (maxima.size() >= options.most) break;
        const grid::PolarPoint center = ShearLayer::center(peak.azimuth, peak.arc);
        const bool is_near = std::ranges::any_of(maxima, [&](const ShearMaximum& stronger) {
            return separation_m(stronger.from_radar, center) < options.least_separation_m;
        });
        if (is_near) continue;
        const ShearCell& cell = layer.at(peak.azimuth, peak.arc);
        maxima.push_back({frame.to_geo(center), center, cell.azimuthal_per_s, cell.error_per_s,
                          cell.height_m, cell.time});
    }
    return maxima;
}

}  // namespace stormcellar::retrieve

#include "web/doors/storms/rotation_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "stormcellar/grid/audit_row.h"
#include "stormcellar/retrieve/shear_peaks.h"

namespace stormcellar::web {
namespace {

// Layers above the lowest antenna of the grid, as MRMS has them above the ground.
struct RotationLayer {
    std::string_view name;
    double bottom_m, top_m;
};
constexpr std::array rotation_layers{RotationLayer{"low", 0, 2000},
                                     RotationLayer{"mid", 3000, 6000}};
constexpr double units_of_shear = 1e-3;  // AZSH is in 0.001/s

double lowest_antenna_m(const std::vector<grid::SitePosition>& sites) {
    if (sites.empty()) return 0;
    return std::ranges::min_element(sites, {}, &grid::SitePosition::altitude_m)->altitude_m;
}

double rounded(double value, double digits) {
    const double scale = std::pow(10.0, digits);
    return std::round(value * scale) / scale;
}

}  // namespace

void add_rotation(const OpenGrid& grid, ApiJson& features) {
    const cache::GridDescription& description = grid.file.description();
    const double base_m = lowest_antenna_m(description.sites);
    const grid::AuditRow audit = grid::pooled(description.provenance.audit);
    for (const RotationLayer& layer : rotation_layers) {
        const auto peaks = retrieve::shear_peaks(
            grid.file.view(), {.bottom_m = base_m + layer.bottom_m, .top_m = base_m + layer.top_m});
        for (const retrieve::ShearPeak& peak : peaks) {
            ApiJson properties{
                {"kind", "shear_maximum"},
                {"area", grid.domain},
                {"time", format_utc(grid.time)},
                {"layer", layer.name},
                {"azimuthal_shear_per_s", rounded(static_cast<double>(peak.azimuthal_per_s), 5)},
                {"height_m", rounded(peak.height_m, 0)}};
            if (audit.count > 0) {
                properties["gridding_rms_per_s"] =
                    rounded(static_cast<double>(audit.rms) * units_of_shear, 6);
            }
            features.push_back({{"type", "Feature"},
                                {"geometry",
                                 {{"type", "Point"},
                                  {"coordinates",
                                   {rounded(peak.position.longitude_deg, 5),
                                    rounded(peak.position.latitude_deg, 5)}}}},
                                {"properties", std::move(properties)}});
        }
    }
}

}  // namespace stormcellar::web

#include "grid/column_geometry.h"

#include <cmath>
#include <utility>

#include "grid/gridder.h"
#include "grid/site_frame.h"

namespace stormcellar::grid {
namespace {

ColumnPlace narrow(PolarPoint point) {
    auto azimuth_deg = static_cast<float>(point.azimuth_deg);
    if (azimuth_deg >= 360) azimuth_deg = 0;  // 359.99999 as a float
    return {azimuth_deg, static_cast<float>(point.arc_m)};
}

// The plane of the projection is the polar frame of the site when the grid is centred there.
bool is_centered(const SitePosition& site, const GridSpec& spec) {
    return site.latitude_deg == spec.center_latitude_deg &&
           site.longitude_deg == spec.center_longitude_deg;
}

}  // namespace

ColumnGeometry::ColumnGeometry(SitePosition site, GridSpec spec)
    : site_(std::move(site)), spec_(std::move(spec)) {
    places_.reserve(spec_.column_count());
    const bool centered = is_centered(site_, spec_);
    const SiteFrame center(spec_.center_latitude_deg, spec_.center_longitude_deg);
    const SiteFrame frame(site_.latitude_deg, site_.longitude_deg);
    for (int iy = 0; iy < spec_.ny; ++iy) {
        for (int ix = 0; ix < spec_.nx; ++ix) {
            const PolarPoint in_plane = SiteFrame::from_plane(spec_.x_m(ix), spec_.y_m(iy));
            places_.push_back(
                narrow(centered ? in_plane : frame.to_polar(center.to_geo(in_plane))));
        }
    }
}

GeoPoint column_position(const GridSpec& spec, int ix, int iy) {
    const SiteFrame center(spec.center_latitude_deg, spec.center_longitude_deg);
    return center.to_geo(SiteFrame::from_plane(spec.x_m(ix), spec.y_m(iy)));
}

Result<std::shared_ptr<const ColumnGeometry>> make_column_geometry(const SitePosition& site,
                                                                   const GridSpec& spec) {
    if (auto valid = validate(spec); !valid) return pass_on(valid);
    const bool on_earth = std::abs(site.latitude_deg) <= 90 &&
                          std::abs(site.longitude_deg) <= 360 && std::abs(site.altitude_m) <= 10000;
    if (!on_earth) {
        return fail(ErrorCode::bad_argument, "the site {} at {}, {}, {} m is not on the earth",
                    site.icao, site.latitude_deg, site.longitude_deg, site.altitude_m);
    }
    return std::make_shared<const ColumnGeometry>(site, spec);
}

}  // namespace stormcellar::grid

#include "stormcellar/grid/column_geometry.h"

#include <cmath>
#include <utility>

#include "grid/frame/sphere_frame.h"
#include "grid/place/frame_table.h"
#include "grid/place/site_extent.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

ColumnPlace narrow(PolarPoint point) {
    auto azimuth_deg = static_cast<float>(point.azimuth_deg);
    if (azimuth_deg >= 360) azimuth_deg = 0;  // as a float, 359.99999 may round to 360
    return {azimuth_deg, static_cast<float>(point.arc_m)};
}

// Calls solve(GeoPoint) for every column, row by row.
template <class Solve>
void solve_each(const GridSpec& spec, std::vector<ColumnPlace>& places, Solve solve) {
    const GridProjection projection(spec);
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix)
            places.push_back(narrow(solve(projection.to_geo({1.0 * ix, 1.0 * iy}))));
    }
}

}  // namespace

ColumnGeometry::ColumnGeometry(SitePosition site, GridSpec spec, ChosenFrame kind)
    : site_(std::move(site)), spec_(std::move(spec)), kind_(kind) {
    places_.reserve(spec_.column_count());
    if (is_centered_at(site_, spec_)) {
        fill_centered();
    } else if (kind_ == FrameKind::sphere) {
        fill_on_sphere();
    } else if (kind_ == FrameKind::table) {
        fill_from_table();
    } else {
        fill_by_geodesics();
    }
    tiles_ = make_tiles(*this);
}

void ColumnGeometry::fill_centered() {
    for (int iy = 0; iy < spec_.ny; ++iy) {
        for (int ix = 0; ix < spec_.nx; ++ix)
            places_.push_back(narrow(SiteFrame::from_plane(spec_.x_m(ix), spec_.y_m(iy))));
    }
}

void ColumnGeometry::fill_by_geodesics() {
    const SiteFrame frame(site_.latitude_deg, site_.longitude_deg);
    solve_each(spec_, places_, [&](GeoPoint point) { return frame.to_polar(point); });
}

void ColumnGeometry::fill_on_sphere() {
    const SphereFrame frame(site_.latitude_deg, site_.longitude_deg);
    solve_each(spec_, places_, [&](GeoPoint point) { return frame.to_polar(point); });
}

void ColumnGeometry::fill_from_table() {
    places_.resize(spec_.column_count());
    const SiteFrame frame(site_.latitude_deg, site_.longitude_deg);
    fill_by_table(spec_, frame, [&](int iy, int first_ix, std::span<const PlanePoint> run) {
        ColumnPlace* to = places_.data() +
                          static_cast<std::size_t>(spec_.nx) * static_cast<std::size_t>(iy) +
                          first_ix;
        for (const PlanePoint& place : run)
            *to++ = narrow(SiteFrame::from_plane(place.x_m, place.y_m));
    });
}

Result<std::shared_ptr<const ColumnGeometry>> make_column_geometry(const SitePosition& site,
                                                                   const GridSpec& spec,
                                                                   ChosenFrame kind) {
    if (auto valid = validate(spec); !valid) return pass_on(valid);
    if (Status good = check_on_earth(site); !good) return pass_on(good);
    return std::make_shared<const ColumnGeometry>(site, spec, kind);
}

}  // namespace stormcellar::grid

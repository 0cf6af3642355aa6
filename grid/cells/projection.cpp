#include "stormcellar/grid/projection.h"

#include <cmath>
#include <numbers>

#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/Math.hpp>

#include "base/floating_point.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::grid {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr double rounding_deg = 1e-9;        // 0.1 mm; sums of spacings may be off by this much
constexpr double largest_parallel_deg = 89;  // limit for the parallels and the center of a cone
// A cone whose mean parallel is nearer to the equator is a cylinder.
constexpr double flattest_cone_deg = 0.01;

using Cone = GeographicLib::LambertConformalConic;

Cone cone_of(const GridSpec& spec) {
    const MaskedTraps masked;
    return {wgs84_semi_major_m, wgs84_flattening, spec.parallels_deg[0], spec.parallels_deg[1], 1};
}

double cone_northing_m(const Cone& cone, double latitude_deg) {
    const MaskedTraps masked;
    double x_m = 0;
    double y_m = 0;
    cone.Forward(0, latitude_deg, 0, x_m, y_m);
    return y_m;
}

Status validate_degrees(const GridSpec& spec) {
    const double middle_deg = spec.center_latitude_deg + spec.offset_y_cells * spec.spacing_deg;
    const double reach_deg = std::abs(middle_deg) + 0.5 * spec.ny * spec.spacing_deg;
    if (reach_deg > 90 + rounding_deg) {
        return fail(ErrorCode::bad_argument,
                    "a latitude-longitude grid ends at the poles: {} rows of {} degrees around "
                    "latitude {} go beyond; use azimuthal_equidistant there",
                    spec.ny, spec.spacing_deg, middle_deg);
    }
    const double half_width = std::abs(spec.offset_x_cells) + 0.5 * spec.nx;
    if (half_width * spec.spacing_deg > 180 + rounding_deg) {
        return fail(ErrorCode::bad_argument,
                    "{} columns of {} degrees span more than 360 degrees around the center",
                    spec.nx, spec.spacing_deg);
    }
    return {};
}

Status validate_parallels(const GridSpec& spec) {
    const auto [first_deg, second_deg] = spec.parallels_deg;
    for (const double parallel_deg : spec.parallels_deg) {
        if (!is_within(parallel_deg, -largest_parallel_deg, largest_parallel_deg)) {
            return fail(ErrorCode::bad_argument,
                        "standard parallels must lie within -{0} to {0} degrees, not at {1}; use "
                        "azimuthal_equidistant around a pole",
                        largest_parallel_deg, parallel_deg);
        }
    }
    if (std::abs(spec.center_latitude_deg) > largest_parallel_deg) {
        return fail(ErrorCode::bad_argument,
                    "the center of a Lambert conformal grid must lie within -{0} to {0} degrees, "
                    "not at {1}; use azimuthal_equidistant around a pole",
                    largest_parallel_deg, spec.center_latitude_deg);
    }
    if (std::abs(first_deg + second_deg) < 2 * flattest_cone_deg) {
        return fail(ErrorCode::bad_argument,
                    "standard parallels {} and {} are opposite: there is no cone through them; "
                    "choose both on one side of the equator",
                    first_deg, second_deg);
    }
    return {};
}

// Checks a cone, which is cut open along the meridian opposite its center. Beyond the cut, a wedge
// of the plane shows nothing, or places that are elsewhere on the map already. So does the part
// beyond the pole at the tip of the cone. The grid must reach neither of these two areas.
Status validate_cone(const GridSpec& spec) {
    const Cone cone = cone_of(spec);
    // Side of the pole that is at the tip of the cone.
    const double side = cone.OriginLatitude() < 0 ? -1 : 1;
    const double tip_m =
        side * (cone_northing_m(cone, side * 90) - cone_northing_m(cone, spec.center_latitude_deg));
    const double half_width_m = (std::abs(spec.offset_x_cells) + 0.5 * spec.nx) * spec.spacing_m;
    // The height of the cone that the grid must not exceed on the side of the tip.
    const double height_m = (side * spec.offset_y_cells + 0.5 * spec.ny) * spec.spacing_m;
    const double turn_deg = std::atan2(half_width_m, tip_m - height_m) * degrees_per_radian;
    const double cut_deg = 180 * std::sin(std::abs(cone.OriginLatitude()) / degrees_per_radian);
    if (tip_m > height_m && turn_deg < cut_deg) return {};
    return fail(ErrorCode::bad_argument,
                "a Lambert conformal grid cannot hold a pole or the meridian opposite its center: "
                "{} x {} columns of {} m around {}, {} with parallels {} and {} do",
                spec.nx, spec.ny, spec.spacing_m, spec.center_latitude_deg,
                spec.center_longitude_deg, spec.parallels_deg[0], spec.parallels_deg[1]);
}

}  // namespace

struct GridProjection::Constants {
    Cone cone;
    double cone_y_m = 0;  // distance of the center from the origin of the cone
};

GridProjection::GridProjection(const GridSpec& spec)
    : kind_(spec.projection),
      center_(spec.center_latitude_deg, spec.center_longitude_deg),
      center_latitude_deg_(spec.center_latitude_deg),
      center_longitude_deg_(spec.center_longitude_deg),
      spacing_(spec.in_degrees() ? spec.spacing_deg : spec.spacing_m),
      center_x_(spec.center_x()),
      center_y_(spec.center_y()) {
    if (kind_ != Projection::lambert_conformal) return;
    const Cone cone = cone_of(spec);
    constants_ = std::make_shared<const Constants>(
        Constants{cone, cone_northing_m(cone, center_latitude_deg_)});
}

double GridProjection::row_latitude_deg(double y) const noexcept {
    return center_latitude_deg_ + (y - center_y_) * spacing_;
}

double GridProjection::column_longitude_deg(double x) const noexcept {
    return center_longitude_deg_ + (x - center_x_) * spacing_;
}

double GridProjection::continuous_longitude_deg(double longitude_deg) const noexcept {
    return center_longitude_deg_ +
           GeographicLib::Math::AngDiff(center_longitude_deg_, longitude_deg);
}

GeoPoint GridProjection::to_geo(ColumnPoint column) const noexcept {
    const MaskedTraps masked;
    const double x_m = (column.x - center_x_) * spacing_;
    const double y_m = (column.y - center_y_) * spacing_;
    GeoPoint point;
    switch (kind_) {
        case Projection::azimuthal_equidistant:
            point = center_.to_geo(SiteFrame::from_plane(x_m, y_m));
            break;
        case Projection::latitude_longitude:
            point = {row_latitude_deg(column.y),
                     GeographicLib::Math::AngNormalize(column_longitude_deg(column.x))};
            break;
        case Projection::lambert_conformal:
            constants_->cone.Reverse(center_longitude_deg_, x_m, y_m + constants_->cone_y_m,
                                     point.latitude_deg, point.longitude_deg);
            break;
    }
    return point;
}

ColumnPoint GridProjection::to_column(GeoPoint point) const noexcept {
    const MaskedTraps masked;
    double x = 0;
    double y = 0;
    switch (kind_) {
        case Projection::latitude_longitude:
            x = GeographicLib::Math::AngDiff(center_longitude_deg_, point.longitude_deg);
            y = point.latitude_deg - center_latitude_deg_;
            break;
        case Projection::azimuthal_equidistant: {
            const PlanePoint plane = SiteFrame::to_plane(center_.to_polar(point));
            x = plane.x_m;
            y = plane.y_m;
            break;
        }
        case Projection::lambert_conformal:
            constants_->cone.Forward(center_longitude_deg_, point.latitude_deg, point.longitude_deg,
                                     x, y);
            y -= constants_->cone_y_m;
            break;
    }
    return {center_x_ + x / spacing_, center_y_ + y / spacing_};
}

GeoPoint column_position(const GridSpec& spec, int ix, int iy) {
    return GridProjection(spec).to_geo({static_cast<double>(ix), static_cast<double>(iy)});
}

Status validate_projection(const GridSpec& spec) {
    switch (spec.projection) {
        case Projection::azimuthal_equidistant:
            return {};
        case Projection::latitude_longitude:
            return validate_degrees(spec);
        case Projection::lambert_conformal:
            if (Status parallels = validate_parallels(spec); !parallels) return parallels;
            return validate_cone(spec);
    }
    return fail(ErrorCode::bad_argument, "there is no projection {}",
                static_cast<int>(spec.projection));
}

}  // namespace stormcellar::grid

#include "grid/place/site_columns.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

constexpr double reach_m = 500e3;

// Returns the largest distance from exact geodesics within reach, in meters.
double greatest_error_m(const SitePosition& site, const GridSpec& spec) {
    const SiteColumns columns(site, spec, reach_m);
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    const GridProjection projection(spec);
    double greatest = 0;
    for (double azimuth_deg = 0.7; azimuth_deg < 360; azimuth_deg += 7.3) {
        const double azimuth = azimuth_deg * std::numbers::pi / 180;
        for (double arc_m = 0; arc_m <= reach_m; arc_m += 9.7e3) {
            const auto exact = projection.to_column(frame.to_geo({azimuth_deg, arc_m}));
            const auto found = columns.at(std::sin(azimuth), std::cos(azimuth), arc_m);
            greatest = std::max(greatest, std::hypot((found.x - exact.x) * spec.cell_width_m(),
                                                     (found.y - exact.y) * spec.cell_height_m()));
        }
    }
    return greatest;
}

GridSpec spec_of(Projection projection, double latitude_deg, double longitude_deg) {
    GridSpec spec = default_spec(latitude_deg, longitude_deg);
    spec.projection = projection;
    if (projection == Projection::lambert_conformal)
        spec.parallels_deg = {latitude_deg, latitude_deg};
    if (projection == Projection::latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = 0.01;
    }
    return spec;
}

TEST(SiteColumns, AboutTheSiteAreTheFormula) {
    for (const double latitude_deg : {0.0, 35.0, -71.0, 90.0}) {
        const SitePosition site{"KTLX", latitude_deg, -97, 0};
        EXPECT_LT(
            greatest_error_m(site, spec_of(Projection::azimuthal_equidistant, latitude_deg, -97)),
            1e-6);
    }
}

TEST(SiteColumns, OfPlaneProjectionsAreWithinFiveMetres) {
    for (const auto projection :
         {Projection::azimuthal_equidistant, Projection::lambert_conformal}) {
        for (const double latitude_deg : {20.0, 35.0, 60.0}) {
            for (const double apart_deg : {0.0, 1.0, 8.0, 13.0}) {
                const SitePosition site{"KTLX", latitude_deg, -97 + apart_deg, 0};
                const double north_deg = apart_deg > 10 ? 0 : -apart_deg / 2;
                EXPECT_LT(
                    greatest_error_m(site, spec_of(projection, latitude_deg + north_deg, -97)), 5)
                    << projection_name(projection) << ' ' << latitude_deg << ' ' << apart_deg;
            }
        }
    }
}

TEST(SiteColumns, OfLatitudesAndLongitudesAreAsStated) {
    for (const double latitude_deg : {0.0, 13.0, 35.0, 60.0, -60.0, 75.0}) {
        const SitePosition site{"KTLX", latitude_deg, 179, 0};
        const auto spec = spec_of(Projection::latitude_longitude, latitude_deg, -179.5);
        EXPECT_LT(greatest_error_m(site, spec), std::abs(latitude_deg) > 60 ? 90 : 30)
            << latitude_deg;
    }
    const SitePosition far{"PAPD", 80, 179, 0};
    EXPECT_LT(greatest_error_m(far, spec_of(Projection::latitude_longitude, 80, 179)), 1e-6);
}

}  // namespace
}  // namespace stormcellar::grid

// Tests every column of the table against its own geodesic, including where the plane is not
// smooth.
#include "grid/place/frame_table.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

struct Case {
    const char* what;
    Projection projection;
    GeoPoint center;
    double spacing;  // meters or degrees
    GeoPoint site;
    bool few_geodesics;  // true if the table must need few geodesics for this case
};

using enum Projection;
const Case cases[] = {
    {"off centre", azimuthal_equidistant, {36.1, -96.2}, 3000, {35.33, -97.28}, true},
    {"off centre", latitude_longitude, {36.1, -96.2}, 0.03, {35.33, -97.28}, true},
    {"off centre", lambert_conformal, {36.1, -96.2}, 3000, {35.33, -97.28}, true},
    {"site in a corner", lambert_conformal, {36.1, -96.2}, 3000, {34.2, -98.4}, true},
    {"site on a column", latitude_longitude, {36, -96}, 0.01, {36.005, -96.005}, true},
    {"site outside", azimuthal_equidistant, {40, -80}, 1000, {35.33, -97.28}, true},
    {"fine cells", azimuthal_equidistant, {36.1, -96.2}, 10, {36.101, -96.201}, true},
    {"fine cells", latitude_longitude, {36.1, -96.2}, 0.0001, {36.101, -96.201}, true},
    {"Guam", latitude_longitude, {13.45, 179.98}, 0.02, {13.45, -179.9}, true},
    {"Guam", lambert_conformal, {13.45, 179.98}, 2000, {13.45, -179.9}, true},
    {"Alaska", latitude_longitude, {64.5, -179.9}, 0.02, {64.5, 178}, true},
    {"far north", latitude_longitude, {78, 15}, 0.03, {78.9, 12}, true},
    {"far south", lambert_conformal, {-71, 0}, 3000, {-71.7, -2}, true},
    {"up to the pole", latitude_longitude, {88.5, 0}, 0.02, {89.5, 100}, false},
    {"at the pole", azimuthal_equidistant, {89.9, 10}, 1000, {89.5, 100}, true},
    {"at the pole", azimuthal_equidistant, {-89.9, 10}, 1000, {-90, 0}, true},
    {"near the tip", lambert_conformal, {88.0, 10}, 2000, {88.5, 100}, false},
    {"equator", latitude_longitude, {0, 0}, 0.02, {0.5, 0.5}, true},
    {"equator", lambert_conformal, {0.5, 0}, 2000, {-0.5, 0.5}, true},
    {"large cells", azimuthal_equidistant, {40, -97}, 30000, {35, -90}, false},
    {"huge cells", azimuthal_equidistant, {40, -97}, 100000, {35, -90}, false},
    {"the world", latitude_longitude, {0, 0}, 1.2, {35, -97}, false},
    {"antipode", azimuthal_equidistant, {-35, 83}, 1000, {35.01, -97.02}, false},
    {"antipode", latitude_longitude, {-35, 83}, 0.05, {35.01, -97.02}, false},
};

GridSpec spec_of(const Case& one) {
    GridSpec spec = default_spec(one.center.latitude_deg, one.center.longitude_deg);
    spec.projection = one.projection;
    spec.nx = 151;
    spec.ny = 140;
    if (one.projection == latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = one.spacing;
    } else {
        spec.spacing_m = one.spacing;
    }
    if (one.projection == lambert_conformal) {
        spec.parallels_deg = {one.center.latitude_deg, one.center.latitude_deg};
    }
    return spec;
}

TEST(FrameTable, EveryColumnIsWithinAMillimetreOfItsGeodesic) {
    for (const Case& one : cases) {
        SCOPED_TRACE(one.what);
        const GridSpec spec = spec_of(one);
        ASSERT_TRUE(validate(spec)) << validate(spec).error().message;
        const SiteFrame site(one.site.latitude_deg, one.site.longitude_deg);
        const GridProjection projection(spec);
        std::vector<int> seen(spec.column_count());
        double worst_m = 0;
        const std::size_t geodesics =
            fill_by_table(spec, site, [&](int iy, int first_ix, std::span<const PlanePoint> run) {
                for (std::size_t i = 0; i < run.size(); ++i) {
                    const int ix = first_ix + static_cast<int>(i);
                    ++seen.at(static_cast<std::size_t>(iy) * 151 + static_cast<std::size_t>(ix));
                    const PlanePoint exact =
                        SiteFrame::to_plane(site.to_polar(projection.to_geo({1.0 * ix, 1.0 * iy})));
                    worst_m = std::max(worst_m,
                                       std::hypot(run[i].x_m - exact.x_m, run[i].y_m - exact.y_m));
                }
            });
        EXPECT_LE(worst_m, frame_table_error_m);
        for (const int times : seen)
            ASSERT_EQ(times, 1);
        if (one.few_geodesics) {
            EXPECT_LT(geodesics, spec.column_count() / 20);
        } else {
            EXPECT_LT(geodesics, spec.column_count() * 8 / 5);
        }
    }
}

TEST(FrameTable, AnUsualGridTakesOneGeodesicIn200Columns) {
    GridSpec spec = spec_of(cases[1]);
    spec.nx = spec.ny = 512;
    spec.spacing_deg = 0.01;
    const std::size_t geodesics = fill_by_table(spec, SiteFrame(35.33, -97.28), [](auto...) {});
    EXPECT_LT(geodesics, spec.column_count() / 180);
}

TEST(FrameTable, SmallAndThinGridsAreWhole) {
    for (const auto& [nx, ny] : {std::pair{1, 1}, std::pair{1, 900}, std::pair{900, 1},
                                 std::pair{129, 2}, std::pair{13, 11}}) {
        GridSpec spec = spec_of(cases[2]);
        spec.nx = nx;
        spec.ny = ny;
        const SiteFrame site(35.33, -97.28);
        const GridProjection projection(spec);
        std::size_t columns = 0;
        fill_by_table(spec, site, [&](int iy, int first_ix, std::span<const PlanePoint> run) {
            for (std::size_t i = 0; i < run.size(); ++i, ++columns) {
                const PlanePoint exact = SiteFrame::to_plane(site.to_polar(
                    projection.to_geo({first_ix + static_cast<double>(i), 1.0 * iy})));
                ASSERT_NEAR(run[i].x_m, exact.x_m, frame_table_error_m);
                ASSERT_NEAR(run[i].y_m, exact.y_m, frame_table_error_m);
            }
        });
        EXPECT_EQ(columns, spec.column_count());
    }
}

}  // namespace
}  // namespace stormcellar::grid

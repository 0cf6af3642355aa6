#include "stormcellar/grid/site_distance.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

struct Case {
    Projection projection;
    GeoPoint center;
    double spacing_m;
    int nx, ny;
    GeoPoint site;
};

GridSpec spec_of(const Case& of) {
    GridSpec spec = default_spec(of.center.latitude_deg, of.center.longitude_deg);
    spec.projection = of.projection;
    spec.nx = of.nx;
    spec.ny = of.ny;
    spec.spacing_m = of.spacing_m;
    if (of.projection == Projection::latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = of.spacing_m / 111000;
    }
    if (of.projection == Projection::lambert_conformal) spec.parallels_deg = {33, 45};
    return spec;
}

// Returns the worst error over every third column, as a share of the accuracy in the header.
double worst_of(const Case& of, std::size_t& nodes) {
    const GridSpec domain = spec_of(of);
    const SitePosition site{"TEST", of.site.latitude_deg, of.site.longitude_deg, 0};
    const auto window = site_window(domain, site);
    if (!window) return HUGE_VAL;
    const SiteDistance distance(domain, *window, site);
    nodes = distance.node_count();
    const GridProjection projection(domain);
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    ColumnValues squared_m2{};
    double worst = 0;
    for (int bx = window->first_x / 16; bx < bricks_along(window->end_x()); bx += 2) {
        for (int by = window->first_y / 16; by < bricks_along(window->end_y()); ++by) {
            distance.squared_arcs_m2(bx, by, squared_m2);
            for (int i = (bx + by) % 3; i < 256; i += 3) {
                const int ix = bx * 16 + i / 16;
                const int iy = by * 16 + i % 16;
                if (ix >= domain.nx || iy >= domain.ny) continue;
                const double arc_m = frame.to_polar(projection.to_geo({1.0 * ix, 1.0 * iy})).arc_m;
                if (arc_m > 500e3) continue;
                const double off_m2 = std::abs(
                    static_cast<double>(squared_m2[static_cast<std::size_t>(i)]) - arc_m * arc_m);
                worst = std::max(worst, off_m2 / (0.2 * std::max(arc_m, 100e3)));
                EXPECT_GE(squared_m2[static_cast<std::size_t>(i)], 0);
            }
        }
    }
    return worst;
}

TEST(SiteDistance, IsAsAccurateAsStatedInEveryProjection) {
    using enum Projection;
    const std::vector<Case> cases = {
        {latitude_longitude, {38, -97}, 1110, 1700, 1000, {40.5, -102}},
        {latitude_longitude, {38, -97}, 5550, 1400, 700, {47, -122}},
        {latitude_longitude, {64, -150}, 10000, 500, 300, {71.3, -156.8}},
        {latitude_longitude, {0, 0}, 55500, 720, 360, {87, 20}},
        {latitude_longitude, {85, 0}, 10000, 400, 110, {88, 10}},
        {latitude_longitude, {52, 179.9}, 3000, 500, 500, {51.9, -179.8}},
        {lambert_conformal, {38, -97}, 3000, 1500, 900, {25.6, -80.4}},
        {lambert_conformal, {38, -97}, 100, 1600, 900, {38.2, -97}},
        {lambert_conformal, {38, -97}, 50000, 120, 80, {47.1, -122.5}},
        {azimuthal_equidistant, {38, -97}, 15000, 256, 256, {44, -70}},
        {azimuthal_equidistant, {90, 0}, 4000, 500, 500, {89, 10}},
        {azimuthal_equidistant, {13.4, 144.8}, 1000, 512, 512, {13.4, 144.8}},
        {azimuthal_equidistant, {38, -97}, 50000, 100, 100, {44, -70}},
    };
    for (const Case& of : cases) {
        std::size_t nodes = 0;
        EXPECT_LE(worst_of(of, nodes), 1)
            << projection_name(of.projection) << " of " << of.spacing_m << " m about "
            << of.center.latitude_deg << ", site " << of.site.latitude_deg;
    }
}

TEST(SiteDistance, FineGridsTakeOneGeodesicInSixtyFour) {
    std::size_t nodes = 0;
    const Case fine{Projection::latitude_longitude, {38, -97}, 1110, 1700, 1000, {40.5, -102}};
    EXPECT_LE(worst_of(fine, nodes), 1);
    EXPECT_LT(nodes, 16000U);
}

TEST(SiteDistance, KnowsItsSite) {
    const GridSpec domain = default_spec(40, -90);
    const SiteDistance distance(domain, {0, 0, 64, 64}, {"KDVN", 41.6, -90.6, 200});
    EXPECT_TRUE(distance.is_of({"KDVN", 41.6, -90.6, 250}));
    EXPECT_FALSE(distance.is_of({"KDVN", 41.6, -90.7, 200}));
}

}  // namespace
}  // namespace stormcellar::grid

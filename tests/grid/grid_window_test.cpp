#include "stormcellar/grid/grid_window.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "grid/frame/sphere_frame.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/frame_ladder.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/projection.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

GridSpec domain_of(Projection projection, GeoPoint center, double spacing_m, int nx, int ny) {
    GridSpec spec = default_spec(center.latitude_deg, center.longitude_deg);
    spec.projection = projection;
    spec.nx = nx;
    spec.ny = ny;
    spec.spacing_m = spacing_m;
    if (projection == Projection::latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = spacing_m / 111000;
    }
    if (projection == Projection::lambert_conformal) {
        const double side = center.latitude_deg < 0 ? -1 : 1;
        spec.parallels_deg = {side * 33, side * 45};
    }
    return spec;
}

const std::vector<GridSpec>& domains() {
    using enum Projection;
    static const std::vector<GridSpec> all = {
        domain_of(latitude_longitude, {38, -97}, 1110, 701, 350),
        domain_of(lambert_conformal, {39, -96}, 3000.5, 300, 211),
        domain_of(azimuthal_equidistant, {13.4, 144.8}, 777.7, 255, 256),
        domain_of(latitude_longitude, {60, 179.9}, 5000, 400, 99)};
    return all;
}

TEST(GridWindow, AWindowsColumnsAreTheDomainsToTheBit) {
    for (const GridSpec& domain : domains()) {
        for (const GridWindow window : {GridWindow{0, 0, 16, 16}, GridWindow{32, 48, 97, 32},
                                        GridWindow{7, 3, 200, 50}, GridWindow{250, 90, 1, 9}}) {
            const GridSpec spec = window_spec(domain, window);
            ASSERT_TRUE(validate(spec)) << validate(spec).error().message;
            EXPECT_EQ(window_of(domain, spec), window);
            const GridProjection whole(domain);
            const GridProjection part(spec);
            for (const auto& [ix, iy] :
                 {std::pair{0, 0}, {window.nx - 1, 0}, {window.nx / 2, window.ny - 1}}) {
                EXPECT_EQ(spec.x_m(ix), domain.x_m(window.first_x + ix));
                EXPECT_EQ(spec.y_m(iy), domain.y_m(window.first_y + iy));
                const GeoPoint here = part.to_geo({1.0 * ix, 1.0 * iy});
                const GeoPoint there =
                    whole.to_geo({1.0 * (window.first_x + ix), 1.0 * (window.first_y + iy)});
                EXPECT_EQ(here.latitude_deg, there.latitude_deg);
                EXPECT_EQ(here.longitude_deg, there.longitude_deg);
                const ColumnPoint back = part.to_column(there);
                EXPECT_NEAR(back.x, ix, 1e-6);
                EXPECT_NEAR(back.y, iy, 1e-6);
            }
        }
    }
}

TEST(GridWindow, AWindowOfAWindowIsOneOfTheDomain) {
    const GridSpec& domain = domains().front();
    const GridSpec outer = window_spec(domain, {48, 16, 300, 200});
    const GridSpec inner = window_spec(outer, {5, 7, 33, 44});
    EXPECT_EQ(inner, window_spec(domain, {53, 23, 33, 44}));
    EXPECT_EQ(window_spec(domain, {0, 0, domain.nx, domain.ny}), domain);
}

TEST(GridWindow, OtherGridsAreNoWindows) {
    const GridSpec& domain = domains().front();
    const GridSpec window = window_spec(domain, {16, 16, 64, 32});
    const auto is_window = [&](auto change) {
        GridSpec spec = window;
        change(spec);
        return window_of(domain, spec).has_value();
    };
    EXPECT_TRUE(is_window([](GridSpec&) {}));
    EXPECT_FALSE(is_window([](GridSpec& s) { s.center_latitude_deg += 1e-9; }));
    EXPECT_FALSE(is_window([](GridSpec& s) { s.spacing_deg *= 1.0000001; }));
    EXPECT_FALSE(is_window([](GridSpec& s) { s.levels_m.pop_back(); }));
    EXPECT_FALSE(is_window([](GridSpec& s) { s.offset_x_cells += 0.5; }));
    EXPECT_FALSE(is_window([](GridSpec& s) { s.offset_x_cells += 1000; }));
    EXPECT_FALSE(is_window([](GridSpec& s) { s.offset_y_cells -= 17; }));
    EXPECT_TRUE(is_window([](GridSpec& s) { s.offset_y_cells -= 16; }));
}

TEST(GridWindow, OffsetsAreHalvesWithinTheLargestGrid) {
    const auto valid = [](double offset_cells) {
        GridSpec spec = default_spec(40, -90);
        spec.offset_x_cells = offset_cells;
        return validate(spec).has_value();
    };
    EXPECT_TRUE(valid(0.5));
    EXPECT_TRUE(valid(-7962));
    EXPECT_FALSE(valid(-7962.5));
    EXPECT_FALSE(valid(0.25));
    EXPECT_FALSE(valid(std::numeric_limits<double>::quiet_NaN()));
}

TEST(GridWindow, WholeBricksEndAtBricksOrAtTheDomain) {
    const GridSpec& domain = domains().front();  // 701 x 350 columns
    EXPECT_TRUE(is_whole_bricks(domain, {16, 32, 48, 16}));
    EXPECT_TRUE(is_whole_bricks(domain, {16, 32, 685, 318}));
    EXPECT_FALSE(is_whole_bricks(domain, {8, 32, 40, 16}));
    EXPECT_FALSE(is_whole_bricks(domain, {16, 32, 47, 16}));
}

// The outermost columns within reach of a site.
struct Extremes {
    int least_x = 1 << 20, greatest_x = -1, least_y = 1 << 20, greatest_y = -1;
};
class Columns {
  public:
    explicit Columns(const GridSpec& domain) : domain_(domain) {
        const GridProjection projection(domain);
        for (int ix = 0; ix < domain.nx; ++ix) {
            for (int iy = 0; iy < domain.ny; ++iy)
                places_.push_back(projection.to_geo({1.0 * ix, 1.0 * iy}));
        }
    }
    [[nodiscard]] Extremes within(const SitePosition& site, double reach_m) const {
        const SiteFrame frame(site.latitude_deg, site.longitude_deg);
        const SphereFrame sphere(site.latitude_deg, site.longitude_deg);
        Extremes found;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const double rough_m = sphere.to_polar(places_[i]).arc_m;
            if (rough_m > reach_m * 1.01 + 1) continue;
            if (frame.to_polar(places_[i]).arc_m > reach_m) continue;
            const int ix = static_cast<int>(i) / domain_.ny;
            const int iy = static_cast<int>(i) % domain_.ny;
            found.least_x = std::min(found.least_x, ix);
            found.greatest_x = std::max(found.greatest_x, ix);
            found.least_y = std::min(found.least_y, iy);
            found.greatest_y = std::max(found.greatest_y, iy);
        }
        return found;
    }
    [[nodiscard]] const GridSpec& domain() const { return domain_; }

  private:
    GridSpec domain_;
    std::vector<GeoPoint> places_;
};

void expect_holds_all(const Columns& columns, GeoPoint place, double reach_m, bool tight) {
    const GridSpec& domain = columns.domain();
    const SitePosition site{"TEST", place.latitude_deg, place.longitude_deg, 0};
    const auto window = site_window(domain, site, reach_m);
    const Extremes all = columns.within(site, reach_m);
    SCOPED_TRACE(fmt::format("site {}, {} in {} about {}, {}", place.latitude_deg,
                             place.longitude_deg, projection_name(domain.projection),
                             domain.center_latitude_deg, domain.center_longitude_deg));
    if (all.greatest_x < 0) {
        if (tight && window) {
            EXPECT_LE(std::min(window->nx, window->ny), 16);
        }
        return;
    }
    ASSERT_TRUE(window);
    EXPECT_TRUE(is_whole_bricks(domain, *window));
    EXPECT_LE(window->first_x, all.least_x);
    EXPECT_LE(window->first_y, all.least_y);
    EXPECT_GT(window->end_x(), all.greatest_x);
    EXPECT_GT(window->end_y(), all.greatest_y);
    if (!tight) return;
    EXPECT_GT(window->first_x + 32, all.least_x);
    EXPECT_GT(window->first_y + 32, all.least_y);
    EXPECT_LE(window->end_x() - 32, all.greatest_x);
    EXPECT_LE(window->end_y() - 32, all.greatest_y);
}

TEST(GridWindow, ASiteIsHeldWithAllThatItReaches) {
    using enum Projection;
    const Columns conus(domain_of(latitude_longitude, {38, -97}, 20000, 350, 160));
    const Columns cone(domain_of(lambert_conformal, {38, -97}, 20000, 300, 180));
    const Columns plane(domain_of(azimuthal_equidistant, {38, -97}, 20000, 300, 180));
    for (const GeoPoint place : {GeoPoint{35.3, -97.3}, GeoPoint{47.1, -122.5},
                                 GeoPoint{25.6, -80.4}, GeoPoint{52, -68}, GeoPoint{38, -60}}) {
        for (const double reach_m : {460e3, 130e3, 1.0}) {
            expect_holds_all(conus, place, reach_m, true);
            expect_holds_all(cone, place, reach_m, true);
            expect_holds_all(plane, place, reach_m, true);
        }
    }
}

TEST(GridWindow, AcrossTheAntimeridianAndAboutThePoles) {
    using enum Projection;
    const Columns pacific(domain_of(latitude_longitude, {50, 179.5}, 20000, 300, 150));
    const Columns world(domain_of(latitude_longitude, {0, 0}, 55500, 720, 360));
    const Columns north(domain_of(azimuthal_equidistant, {90, 0}, 30000, 200, 200));
    const Columns alaska(domain_of(lambert_conformal, {62, -155}, 20000, 200, 150));
    for (const double longitude_deg : {-179.9, 179.9, 175.0, -170.0, 180.0})
        expect_holds_all(pacific, {52, longitude_deg}, 460e3, true);
    // A grid around the whole earth is cut at 180 degrees.
    expect_holds_all(world, {52, 179}, 460e3, false);
    expect_holds_all(world, {52, 10}, 460e3, true);
    for (const double latitude_deg : {89.9, 86.5, 85.7, -86.0, 84.0}) {
        expect_holds_all(world, {latitude_deg, 33}, 460e3, false);
        expect_holds_all(north, {latitude_deg, 33}, 460e3, latitude_deg > 0);
    }
    expect_holds_all(alaska, {71, -156}, 460e3, true);
    expect_holds_all(alaska, {51.5, 176}, 460e3, true);
    // Columns that are neighbors at the antipode of the center are far apart on the plane.
    const Columns wide(domain_of(azimuthal_equidistant, {0, 0}, 200000, 200, 200));
    expect_holds_all(wide, {0.5, 179}, 460e3, false);
}

TEST(GridWindow, NoWindowWhereNothingIsReached) {
    const GridSpec conus = domain_of(Projection::latitude_longitude, {38, -97}, 11100, 701, 350);
    EXPECT_FALSE(site_window(conus, {"PGUA", 13.45, 144.81, 100}));
    EXPECT_FALSE(site_window(conus, {"XSOU", -38, -97, 100}));
    GridSpec cone = domain_of(Projection::lambert_conformal, {38, -97}, 11100, 400, 250);
    EXPECT_FALSE(site_window(cone, {"PGUA", 13.45, 144.81, 100}));
}

// Grids one volume on a domain and on a window of it. The cells must be the same, even at the edge
// of the window and by methods that look beyond the cell.
class InAWindow : public ::testing::TestWithParam<std::pair<Interpolation, CellExtent>> {};

TEST_P(InAWindow, AVolumeIsTheSame) {
    level2::Volume volume;
    volume.station = "KTLX";
    for (const double elevation_deg : {0.5, 1.5, 3.0}) {
        SweepPlan plan;
        plan.elevation_deg = elevation_deg;
        plan.cut = static_cast<int>(elevation_deg * 2);
        plan.gates = 150;
        plan.code = [](int radial, int gate) {
            if ((radial / 20 + gate / 10) % 3 == 0) return below_threshold;
            return ref_code(10 + radial % 30 + gate * 0.1);
        };
        volume.sweeps.push_back(make_sweep(plan));
    }
    const SitePosition site{"KTLX", 35.3, -97.3, 380};
    for (const GeoPoint center : {GeoPoint{35.3, -97.3}, GeoPoint{35.9, -96.8}}) {
        GridSpec domain = default_spec(center.latitude_deg, center.longitude_deg);
        domain.nx = 150;
        domain.ny = 140;
        domain.spacing_m = 2000;
        domain.levels_m = {1000, 2000, 4000};
        const GridWindow window{32, 48, 80, 64};
        const auto gridded = [&](const GridSpec& spec) {
            const auto geometry = make_column_geometry(site, spec, FrameKind::geodesic);
            GridderOptions options;
            options.method.interpolation = GetParam().first;
            options.method.cell = GetParam().second;
            auto made = make_grid(volume, site, **geometry, options);
            EXPECT_TRUE(made);
            return *std::move(made);
        };
        const Grid whole = gridded(domain);
        const Grid part = gridded(window_spec(domain, window));
        int values = 0;
        for (int iy = 0; iy < window.ny; ++iy) {
            for (int ix = 0; ix < window.nx; ++ix) {
                for (int iz = 0; iz < domain.nz(); ++iz) {
                    const std::size_t here = part.spec.index(ix, iy, iz);
                    const std::size_t there =
                        domain.index(window.first_x + ix, window.first_y + iy, iz);
                    ASSERT_EQ(part.status[here], whole.status[there]);
                    ASSERT_EQ(part.values[here], whole.values[there]);
                    values += part.status[here] == CellStatus::value ? 1 : 0;
                }
            }
        }
        EXPECT_GT(values, 1000);
        EXPECT_GE(reach_m(site, window_spec(domain, window)) * 1.02,
                  make_column_geometry(site, window_spec(domain, window)).value()->row(0)[0].arc_m);
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, InAWindow,
                         ::testing::Values(std::pair{Interpolation::linear, CellExtent::point},
                                           std::pair{Interpolation::eight_point, CellExtent::point},
                                           std::pair{Interpolation::nearest, CellExtent::area},
                                           std::pair{Interpolation::beam_weighted,
                                                     CellExtent::area}));

}  // namespace
}  // namespace stormcellar::grid

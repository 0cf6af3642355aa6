#include "stormcellar/grid/column_geometry.h"

#include <cmath>

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <gtest/gtest.h>

#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::grid {
namespace {

const SitePosition ktlx{"KTLX", 35.3333, -97.2778, 389};

// Computes a place the slow way: GeographicLib's projection, then the geodesic from the site.
PolarPoint slow_place(const SitePosition& from, const GridSpec& spec, int ix, int iy) {
    const GeographicLib::AzimuthalEquidistant plane;
    double latitude_deg = 0;
    double longitude_deg = 0;
    plane.Reverse(spec.center_latitude_deg, spec.center_longitude_deg, spec.x_m(ix), spec.y_m(iy),
                  latitude_deg, longitude_deg);
    return SiteFrame(from.latitude_deg, from.longitude_deg).to_polar({latitude_deg, longitude_deg});
}

void expect_places(const SitePosition& from, const GridSpec& spec, FrameKind kind) {
    const auto geometry = make_column_geometry(from, spec, kind);
    ASSERT_TRUE(geometry);
    const double place_m = kind == FrameKind::table ? 1e-3 : 1e-6;
    for (int iy = 0; iy < spec.ny; iy += 3) {
        for (int ix = 0; ix < spec.nx; ix += 3) {
            const ColumnPlace place = (*geometry)->row(iy)[static_cast<std::size_t>(ix)];
            const PolarPoint slow = slow_place(from, spec, ix, iy);
            ASSERT_NEAR(place.arc_m, slow.arc_m, 0.02);
            ASSERT_GE(place.azimuth_deg, 0);
            ASSERT_LT(place.azimuth_deg, 360);
            double turn_deg = std::abs(place.azimuth_deg - slow.azimuth_deg);
            turn_deg = std::min(turn_deg, 360 - turn_deg);
            if (slow.arc_m > 0) {
                ASSERT_LT(turn_deg, 2e-5 + place_m / slow.arc_m * 180 / M_PI) << slow.arc_m;
            }
        }
    }
}

void expect_places(const SitePosition& from, const GridSpec& spec) {
    for (const FrameKind kind : {FrameKind::table, FrameKind::geodesic})
        expect_places(from, spec, kind);
}

TEST(ColumnGeometry, CentredAtTheSite) {
    GridSpec spec = default_spec(ktlx.latitude_deg, ktlx.longitude_deg);
    expect_places(ktlx, spec);
    spec.nx = 61;  // a column over the site itself
    spec.ny = 61;
    expect_places(ktlx, spec);
}

TEST(ColumnGeometry, CentredElsewhere) {
    GridSpec spec = square_spec(36.1, -96.2, 100, 4000);
    expect_places(ktlx, spec);
}

TEST(ColumnGeometry, AtThePoleAndAcrossTheAntimeridian) {
    GridSpec spec = square_spec(89.9, 10, 40);
    expect_places({"XPOL", 89.5, 100, 0}, spec);
    spec = square_spec(13.45, -179.9, 40);
    expect_places({"XANT", 13.45, 179.95, 80}, spec);
}

// Uses grids beside their sites that reach to 500 km, and fine grids close to their sites.
TEST(ColumnGeometry, FromSitesAllOverTheEarth) {
    for (const SitePosition& from :
         {SitePosition{"AA", 78, 15, -100}, SitePosition{"BB", 0, 180, 4000},
          SitePosition{"CC", 0.1, -180, 0}, SitePosition{"DD", -71, -179.99, 0}}) {
        for (const double spacing_m : {20.0, 9900.0}) {
            GridSpec spec = square_spec(
                from.latitude_deg + spacing_m / 20e3,
                from.longitude_deg + (from.longitude_deg > 0 ? -1 : 1) * spacing_m / 20e3, 60,
                spacing_m);
            expect_places(from, spec);
        }
    }
}

TEST(ColumnGeometry, ColumnPositionsAreOnTheProjectionsPlane) {
    const GridSpec spec = default_spec(35, -97);
    const GeoPoint point = column_position(spec, 459, 0);
    const PolarPoint polar = SiteFrame(35, -97).to_polar(point);
    EXPECT_NEAR(polar.arc_m, std::hypot(229500, 229500), 1e-6);
    EXPECT_NEAR(polar.azimuth_deg, 135, 1e-9);
}

TEST(ColumnGeometry, RefusesWhatIsNotOnTheEarth) {
    const GridSpec spec = default_spec(35, -97);
    EXPECT_FALSE(make_column_geometry({"XXXX", 91, 0, 0}, spec));
    EXPECT_FALSE(make_column_geometry({"XXXX", std::nan(""), 0, 0}, spec));
    EXPECT_FALSE(make_column_geometry({"XXXX", 35, HUGE_VAL, 0}, spec));
    EXPECT_FALSE(make_column_geometry({"XXXX", 35, 0, 1e5}, spec));
    GridSpec bad = spec;
    bad.nx = 0;
    const auto refused = make_column_geometry(ktlx, bad);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::grid

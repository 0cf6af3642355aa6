// Tests conversions between columns and places for every projection, from pole to pole and across
// the antimeridian.
#include "stormcellar/grid/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::grid {
namespace {

using Real = long double;
constexpr Real one_degree = 3.14159265358979323846264338327950288L / 180;

GridSpec spec_of(Projection projection, GeoPoint center) {
    GridSpec spec = default_spec(center.latitude_deg, center.longitude_deg);
    spec.projection = projection;
    spec.nx = 40;
    spec.ny = 31;
    if (projection == Projection::latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = 0.01;
    }
    if (projection == Projection::lambert_conformal) {
        spec.parallels_deg = {center.latitude_deg, center.latitude_deg};
    }
    return spec;
}

// Returns the spec with a coarser spacing, so that it spans some 4000 km.
GridSpec large(GridSpec spec) {
    spec.spacing_m *= 100;
    spec.spacing_deg *= 100;
    return spec;
}

constexpr GeoPoint centers[] = {{35.3, -97.3}, {64.5, -165.3}, {13.45, 144.8}, {13.45, 180},
                                {52, -179.95}, {-45, 179.99},  {-33.9, 151.2}, {71, 0},
                                {-0.5, -180},  {1, 100},       {-71, -10},     {78, 15},
                                {-71, 180},    {0, 180},       {89.9, 40},     {-89.9, -179.9}};

double turn(double from_deg, double to_deg) {
    return std::remainder(to_deg - from_deg, 360.0);
}

// Returns the distance between two places, accurately only if they are close together.
double apart_m(GeoPoint a, GeoPoint b) {
    return SiteFrame(a.latitude_deg, a.longitude_deg).to_polar(b).arc_m;
}

void expect_round_trips(const GridSpec& spec) {
    ASSERT_TRUE(validate(spec)) << validate(spec).error().message;
    const GridProjection projection(spec);
    const double metres = std::max(spec.spacing_m, spec.spacing_deg * 111700);
    for (double y = 0; y <= spec.ny - 1; y += 2.5) {
        for (double x = 0; x <= spec.nx - 1; x += 3.25) {
            const GeoPoint place = projection.to_geo({x, y});
            ASSERT_LE(std::abs(place.latitude_deg), 90);
            ASSERT_LE(std::abs(place.longitude_deg), 180);
            const ColumnPoint back = projection.to_column(place);
            ASSERT_NEAR(back.x * metres, x * metres, 1e-7);
            ASSERT_NEAR(back.y * metres, y * metres, 1e-7);
            const GeoPoint a_turn_on{place.latitude_deg, place.longitude_deg + 360};
            ASSERT_NEAR(projection.to_column(a_turn_on).x * metres, x * metres, 1e-6);
        }
    }
}

TEST(GridProjection, RoundTripsFromPoleToPole) {
    for (const GeoPoint center : centers) {
        SCOPED_TRACE(center.latitude_deg);
        const bool near_pole = std::abs(center.latitude_deg) > 89;
        expect_round_trips(spec_of(Projection::azimuthal_equidistant, center));
        expect_round_trips(large(spec_of(Projection::azimuthal_equidistant, center)));
        if (near_pole) continue;
        expect_round_trips(spec_of(Projection::latitude_longitude, center));
        GridSpec cone = spec_of(Projection::lambert_conformal, center);
        // The center must not be the cone's own origin, and a cone cannot have the equator as its
        // only parallel.
        cone.parallels_deg = {center.latitude_deg + 3, std::min(center.latitude_deg + 17, 88.0)};
        expect_round_trips(cone);
        const bool has_own_cone = center.latitude_deg != 0;
        if (has_own_cone) expect_round_trips(spec_of(Projection::lambert_conformal, center));
        if (std::abs(center.latitude_deg) < 70) {
            expect_round_trips(large(spec_of(Projection::latitude_longitude, center)));
            if (has_own_cone)
                expect_round_trips(large(spec_of(Projection::lambert_conformal, center)));
        }
    }
    expect_round_trips(spec_of(Projection::azimuthal_equidistant, {90, 0}));
    expect_round_trips(spec_of(Projection::azimuthal_equidistant, {-90, 77}));
}

TEST(GridProjection, TheCentreIsInTheMiddle) {
    for (const GeoPoint center : centers) {
        for (const Projection kind :
             {Projection::azimuthal_equidistant, Projection::latitude_longitude,
              Projection::lambert_conformal}) {
            if (std::abs(center.latitude_deg) > 89 && kind != Projection::azimuthal_equidistant) {
                continue;
            }
            const GridSpec spec = spec_of(kind, center);
            const GridProjection projection(spec);
            EXPECT_LT(apart_m(projection.to_geo({19.5, 15}), center), 1e-7);
            const ColumnPoint middle = projection.to_column(center);
            EXPECT_NEAR(middle.x, 19.5, 1e-10);
            EXPECT_NEAR(middle.y, 15, 1e-10);
        }
    }
}

TEST(GridProjection, AzimuthalEquidistantIsThatOfGeographicLib) {
    const GeographicLib::AzimuthalEquidistant plane;
    for (const GeoPoint center : centers) {
        const GridSpec spec = large(spec_of(Projection::azimuthal_equidistant, center));
        for (int iy = 0; iy < spec.ny; iy += 5) {
            for (int ix = 0; ix < spec.nx; ix += 7) {
                GeoPoint slow;
                plane.Reverse(center.latitude_deg, center.longitude_deg, spec.x_m(ix), spec.y_m(iy),
                              slow.latitude_deg, slow.longitude_deg);
                ASSERT_LT(apart_m(column_position(spec, ix, iy), slow), 1e-7);
            }
        }
    }
}

TEST(GridProjection, LatitudeLongitudeIsRegularAndGoesOnAcrossTheAntimeridian) {
    const GridSpec spec = spec_of(Projection::latitude_longitude, {13.45, 179.9});
    const GridProjection projection(spec);
    for (int ix = 0; ix < spec.nx; ++ix) {
        const double longitude_deg = 179.9 + (ix - 19.5) * 0.01;
        EXPECT_NEAR(projection.column_longitude_deg(ix), longitude_deg, 1e-12);
        const GeoPoint place = projection.to_geo({1.0 * ix, 0});
        EXPECT_NEAR(turn(place.longitude_deg, longitude_deg), 0, 1e-12);
        EXPECT_NEAR(projection.continuous_longitude_deg(place.longitude_deg), longitude_deg, 1e-12);
        EXPECT_NEAR(place.latitude_deg, 13.45 - 15 * 0.01, 1e-12);
        EXPECT_EQ(place.latitude_deg, projection.row_latitude_deg(0));
    }
    EXPECT_NEAR(projection.to_column({13.45, 180}).x, 29.5, 1e-9);
    EXPECT_NEAR(projection.to_column({13.45, -180}).x, 29.5, 1e-9);
    EXPECT_NEAR(projection.to_column({13.45, -179.95}).x, 34.5, 1e-9);
}

// Implements Snyder (1987), Map Projections - A Working Manual, eqs 14-15, 15-7 to 15-11,
// literally.
struct SlowCone {
    Real n, f;
    static constexpr Real flattening = 1 / 298.257223563L;
    static Real e() { return std::sqrt(flattening * (2 - flattening)); }
    static Real m(Real latitude_deg) {
        const Real s = std::sin(latitude_deg * one_degree);
        return std::cos(latitude_deg * one_degree) / std::sqrt(1 - e() * e() * s * s);
    }
    static Real t(Real latitude_deg) {
        const Real s = e() * std::sin(latitude_deg * one_degree);
        return std::tan((45 - latitude_deg / 2) * one_degree) /
               std::pow((1 - s) / (1 + s), e() / 2);
    }
    SlowCone(Real first_deg, Real second_deg) {
        n = first_deg == second_deg
                ? std::sin(first_deg * one_degree)
                : std::log(m(first_deg) / m(second_deg)) / std::log(t(first_deg) / t(second_deg));
        f = m(first_deg) / (n * std::pow(t(first_deg), n));
    }
    [[nodiscard]] Real rho_m(Real latitude_deg) const {
        return 6378137 * f * std::pow(t(latitude_deg), n);
    }
};

TEST(GridProjection, LambertConformalIsTheClosedFormula) {
    for (const auto& [first_deg, second_deg] :
         {std::pair{33.0, 45.0}, std::pair{30.0, 60.0}, std::pair{38.5, 38.5},
          std::pair{-30.0, -60.0}, std::pair{-20.0, 50.0}}) {
        const SlowCone slow(first_deg, second_deg);
        GridSpec spec = large(spec_of(Projection::lambert_conformal, {40, -97.5}));
        spec.parallels_deg = {first_deg, second_deg};
        if (first_deg < 0 && second_deg < 0) spec.center_latitude_deg = -40;
        ASSERT_TRUE(validate(spec));
        const GridProjection projection(spec);
        const Real rho0_m = slow.rho_m(spec.center_latitude_deg);
        for (int iy = 0; iy < spec.ny; iy += 3) {
            for (int ix = 0; ix < spec.nx; ix += 3) {
                const GeoPoint place = projection.to_geo({1.0 * ix, 1.0 * iy});
                const Real rho_m = slow.rho_m(place.latitude_deg);
                const Real theta = slow.n * turn(-97.5, place.longitude_deg) * one_degree;
                ASSERT_NEAR(static_cast<double>(rho_m * std::sin(theta)), spec.x_m(ix), 1e-6);
                ASSERT_NEAR(static_cast<double>(rho0_m - rho_m * std::cos(theta)), spec.y_m(iy),
                            1e-6);
            }
        }
    }
}

TEST(GridProjection, LambertConformalIsTrueToScaleAlongItsParallels) {
    GridSpec spec = spec_of(Projection::lambert_conformal, {39, -97});
    spec.parallels_deg = {33, 45};
    const GridProjection projection(spec);
    const auto scale_at = [&](double latitude_deg) {
        const ColumnPoint here = projection.to_column({latitude_deg, -97});
        const GeoPoint east = projection.to_geo({here.x + 1, here.y});
        return spec.spacing_m / apart_m({latitude_deg, -97}, east);
    };
    EXPECT_NEAR(scale_at(33), 1, 1e-7);
    EXPECT_NEAR(scale_at(45), 1, 1e-7);
    EXPECT_LT(scale_at(39), 0.996);
}

TEST(GridProjection, WhatCannotBeShownIsFarOutsideAndNothingThrows) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Projection kind : {Projection::azimuthal_equidistant, Projection::latitude_longitude,
                                  Projection::lambert_conformal}) {
        const GridSpec spec = spec_of(kind, {35, -97});
        const GridProjection projection(spec);
        for (const GeoPoint far : {GeoPoint{-90, 0}, {90, 0}, {-35, 83}, {0, 83}, {35, 83}}) {
            const ColumnPoint at = projection.to_column(far);
            EXPECT_TRUE(std::abs(at.x) > 1000 || std::abs(at.y) > 1000) << at.x << ' ' << at.y;
        }
        EXPECT_TRUE(std::isnan(projection.to_column({nan, 0}).y));
        EXPECT_TRUE(std::isnan(projection.to_column({0, nan}).x));
    }
}

std::string why_refused(const GridSpec& spec) {
    const Status status = validate(spec);
    if (status) return "";
    EXPECT_EQ(status.error().code, ErrorCode::bad_argument);
    return status.error().message;
}

TEST(GridProjection, WhatAProjectionCannotHoldIsRefusedWithAReason) {
    const auto refused = [](Projection kind, GeoPoint center, std::string_view part, auto change) {
        GridSpec spec = spec_of(kind, center);
        change(spec);
        const std::string why = why_refused(spec);
        EXPECT_NE(why.find(part), std::string::npos) << part << " in '" << why << "'";
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto same = [](GridSpec&) {};
    using enum Projection;
    refused(latitude_longitude, {89.9, 0}, "ends at the poles", same);
    refused(latitude_longitude, {-90, 0}, "ends at the poles", same);
    refused(latitude_longitude, {0, 0}, "columns and rows", [](auto& s) { s.nx = 36001; });
    refused(latitude_longitude, {0, 0}, "360 degrees", [](auto& s) {
        s.nx = 36001 / 4;
        s.spacing_deg = 0.041;
    });
    refused(latitude_longitude, {0, 0}, "10 degrees", [](auto& s) { s.spacing_deg = 10.1; });
    refused(latitude_longitude, {0, 0}, "above 0", [](auto& s) { s.spacing_deg = 0; });
    refused(latitude_longitude, {0, 0}, "above 0", [&](auto& s) { s.spacing_deg = nan; });
    refused(latitude_longitude, {0, 0}, "no spacing in meters", [](auto& s) { s.spacing_m = 1; });
    refused(latitude_longitude, {0, 0}, "parallels", [](auto& s) { s.parallels_deg = {1, 1}; });
    refused(azimuthal_equidistant, {0, 0}, "no spacing in deg", [](auto& s) { s.spacing_deg = 1; });
    refused(azimuthal_equidistant, {0, 0}, "parallels", [](auto& s) { s.parallels_deg[1] = 1; });
    refused(lambert_conformal, {0, 0}, "opposite", same);
    refused(lambert_conformal, {35, 0}, "opposite", [](auto& s) { s.parallels_deg = {35, -35}; });
    refused(lambert_conformal, {35, 0}, "opposite", [](auto& s) { s.parallels_deg = {}; });
    refused(lambert_conformal, {35, 0}, "not at 90", [](auto& s) { s.parallels_deg = {35, 90}; });
    refused(lambert_conformal, {35, 0}, "not at nan", [&](auto& s) { s.parallels_deg = {nan, 3}; });
    refused(lambert_conformal, {89.5, 0}, "center", [](auto& s) { s.parallels_deg = {60, 60}; });
    refused(lambert_conformal, {88.9, 0}, "cannot hold a pole",
            [](auto& s) { s.spacing_m = 9000; });
    refused(lambert_conformal, {-88.9, 0}, "cannot hold a pole",
            [](auto& s) { s.spacing_m = 9000; });
    refused(lambert_conformal, {10, 0}, "opposite its center", [](auto& s) { s.spacing_m = 1e6; });
    GridSpec bad = spec_of(azimuthal_equidistant, {35, 0});
    bad.projection = static_cast<Projection>(projection_facts.size());
    EXPECT_NE(why_refused(bad), "");

    GridSpec world = spec_of(latitude_longitude, {0, 180});
    world.spacing_deg = 0.5;
    world.nx = 720;
    world.ny = 360;
    EXPECT_EQ(why_refused(world), "") << "from pole to pole and all around the earth";
}

TEST(GridProjection, NamesAreReadAsTheyAreWritten) {
    for (const ProjectionFacts& facts : projection_facts)
        EXPECT_EQ(projection_from_name(facts.name), facts.projection);
    EXPECT_FALSE(projection_from_name("mercator"));
}

TEST(GridProjection, ACellOfDegreesHasTheSizeThatGeodesicsGive) {
    for (const double latitude_deg : {0.0, 13.45, -35.0, 64.5, 78.0}) {
        const DegreeLength length = degree_length(latitude_deg);
        EXPECT_NEAR(length.north_m,
                    1e4 * apart_m({latitude_deg - 5e-5, 0}, {latitude_deg + 5e-5, 0}), 1e-3);
        EXPECT_NEAR(length.east_m, 1e4 * apart_m({latitude_deg, -5e-5}, {latitude_deg, 5e-5}),
                    1e-3);
        const GridSpec spec = spec_of(Projection::latitude_longitude, {latitude_deg, 20});
        EXPECT_EQ(spec.cell_width_m(), length.east_m * 0.01);
        EXPECT_EQ(spec.cell_height_m(), length.north_m * 0.01);
    }
}

}  // namespace
}  // namespace stormcellar::grid

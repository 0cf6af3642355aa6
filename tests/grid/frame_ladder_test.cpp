// Tests the error bounds of the ways to compute coordinates about a site (rungs of the site frame).
// The bounds must always hold and be at most twice the error.
#include "stormcellar/grid/frame_ladder.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "grid/frame/sphere_frame.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/projection.h"
#include "tests/grid/quad.h"

namespace stormcellar::grid {
namespace {

constexpr double latitudes_deg[] = {90, 89.5, 78, 65, 55, 45, 35, 20, 5, 0, -30, -71, -90};
constexpr double longitudes_deg[] = {-97.3, 180, -180};

double apart_m(PolarPoint a, PolarPoint b) {
    const PlanePoint first = SiteFrame::to_plane(a);
    const PlanePoint second = SiteFrame::to_plane(b);
    return std::hypot(first.x_m - second.x_m, first.y_m - second.y_m);
}

// Returns the largest error of the sphere over 128 azimuths at an arc.
double sphere_error_m(GeoPoint site, double arc_m) {
    const SiteFrame exact(site.latitude_deg, site.longitude_deg);
    const SphereFrame sphere(site.latitude_deg, site.longitude_deg);
    double worst_m = 0;
    for (int i = 0; i < 128; ++i) {
        const PolarPoint truth{i * 360.0 / 128, arc_m};
        worst_m = std::max(worst_m, apart_m(sphere.to_polar(exact.to_geo(truth)), truth));
    }
    return worst_m;
}

TEST(FrameLadder, TheBoundOfTheSphereHoldsAndIsTight) {
    for (const double latitude_deg : latitudes_deg) {
        for (const double longitude_deg : longitudes_deg) {
            for (const double arc_m : {1e3, 1e4, 5e4, 1e5, 2.3e5, 3e5, 4.6e5, 4.7e5}) {
                const double bound_m = sphere_error_bound_m(latitude_deg, arc_m);
                const double worst_m = sphere_error_m({latitude_deg, longitude_deg}, arc_m);
                EXPECT_LE(worst_m, bound_m) << latitude_deg << ' ' << arc_m;
                EXPECT_LT(bound_m, 1.1 * worst_m) << latitude_deg << ' ' << arc_m;
            }
        }
    }
}

TEST(FrameLadder, TheBoundOfTheSphereHoldsToTheAntipode) {
    for (const double latitude_deg : latitudes_deg) {
        for (const double arc_m : {1e6, 3e6, 6e6, 9e6, 12e6, 16e6, 19.9e6}) {
            EXPECT_LE(sphere_error_m({latitude_deg, 10}, arc_m),
                      sphere_error_bound_m(latitude_deg, arc_m))
                << latitude_deg << ' ' << arc_m;
        }
    }
}

// The errors at 35 N (237, 566 and 1209 m) were measured independently before this code was
// written.
TEST(FrameLadder, TheSphereIsOffByWhatWasMeasured) {
    EXPECT_NEAR(sphere_error_m({35, -97}, 100e3), 237, 1);
    EXPECT_NEAR(sphere_error_m({35, -97}, 230e3), 566, 1);
    EXPECT_NEAR(sphere_error_m({35, -97}, 460e3), 1209, 1);
    EXPECT_NEAR(sphere_error_bound_m(35, 100e3), 240, 1);
    EXPECT_NEAR(sphere_error_bound_m(35, 230e3), 573, 1);
    EXPECT_NEAR(sphere_error_bound_m(35, 460e3), 1226, 1);
}

// Computes the textbook's haversines, for which 113 bits are enough at the antipode.
PolarPoint slow_sphere(GeoPoint from, GeoPoint to) {
    const Quad degree = acosq(-1) / 180;
    const Quad a = from.latitude_deg * degree;
    const Quad b = to.latitude_deg * degree;
    const Quad turn = (Quad{to.longitude_deg} - Quad{from.longitude_deg}) * degree;
    const Quad across = sinq((b - a) / 2);
    const Quad around = sinq(turn / 2);
    const Quad h = across * across + cosq(a) * cosq(b) * around * around;
    const Quad arc_m = 2 * Quad{6371000} * asinq(sqrtq(h < 1 ? h : 1));
    const Quad azimuth_deg =
        atan2q(cosq(b) * sinq(turn), cosq(a) * sinq(b) - sinq(a) * cosq(b) * cosq(turn)) / degree;
    return {static_cast<double>(azimuth_deg < 0 ? azimuth_deg + 360 : azimuth_deg),
            static_cast<double>(arc_m)};
}

TEST(FrameLadder, GreatCirclesAreThoseOf113BitFloatsUpToTheAntipode) {
    for (const double latitude_deg : latitudes_deg) {
        const GeoPoint site{latitude_deg, 179.9};
        const SphereFrame sphere(site.latitude_deg, site.longitude_deg);
        const SiteFrame exact(site.latitude_deg, site.longitude_deg);
        for (const double arc_m : {0.01, 1.0, 100.0, 1e4, 4.7e5, 5e6, 1.5e7, 1.9e7, 1.99e7}) {
            const double theta = arc_m / SphereFrame::radius_m;
            const double most_m = arc_m > 1.9e7 ? 1e-7 * theta / std::sin(theta) : 1e-7;
            for (int i = 0; i < 64; ++i) {
                const GeoPoint to = exact.to_geo({i * 360.0 / 64 + 1, arc_m});
                const PolarPoint fast = sphere.to_polar(to);
                ASSERT_GE(fast.azimuth_deg, 0);
                ASSERT_LT(fast.azimuth_deg, 360);
                ASSERT_LT(apart_m(fast, slow_sphere(site, to)), most_m) << latitude_deg << arc_m;
            }
        }
        // The antipode has no azimuth, so stay beside it.
        const GeoPoint antipode{-latitude_deg, -0.1};
        EXPECT_NEAR(sphere.to_polar(antipode).arc_m, M_PI * 6371000, 1e-7) << latitude_deg;
        const PolarPoint here = sphere.to_polar(site);
        EXPECT_EQ(here.arc_m, 0);
        EXPECT_EQ(here.azimuth_deg, 0);
    }
}

GridSpec about(GeoPoint center, Projection projection, double extent_m) {
    GridSpec spec = default_spec(center.latitude_deg, center.longitude_deg);
    spec.projection = projection;
    spec.nx = spec.ny = 75;
    spec.spacing_m = extent_m / 75;
    if (projection == Projection::latitude_longitude) {
        spec.spacing_deg = spec.spacing_m / 111000;
        spec.spacing_m = 0;
    }
    if (projection == Projection::lambert_conformal) {
        spec.parallels_deg = {center.latitude_deg, center.latitude_deg};
    }
    return spec;
}

struct Measured {
    double farthest_m = 0, worst_m = 0;
};
Measured measure(const ColumnGeometry& geometry) {
    const SiteFrame exact(geometry.site().latitude_deg, geometry.site().longitude_deg);
    const GridProjection projection(geometry.spec());
    Measured measured;
    for (int iy = 0; iy < geometry.spec().ny; ++iy) {
        for (int ix = 0; ix < geometry.spec().nx; ++ix) {
            const ColumnPlace place = geometry.row(iy)[static_cast<std::size_t>(ix)];
            const PolarPoint truth = exact.to_polar(projection.to_geo({1.0 * ix, 1.0 * iy}));
            measured.farthest_m = std::max(measured.farthest_m, truth.arc_m);
            measured.worst_m =
                std::max(measured.worst_m, apart_m({place.azimuth_deg, place.arc_m}, truth));
        }
    }
    return measured;
}

void expect_bound(const SitePosition& site, const GridSpec& spec, FrameKind kind) {
    const auto geometry = make_column_geometry(site, spec, kind);
    ASSERT_TRUE(geometry);
    EXPECT_EQ((*geometry)->frame_kind(), kind);
    const Measured measured = measure(**geometry);
    const double bound_m = frame_error_bound_m(kind, site, spec);
    EXPECT_LE(measured.worst_m, bound_m);
    EXPECT_LT(bound_m, 2 * measured.worst_m);
    EXPECT_GE(reach_m(site, spec), measured.farthest_m);
    EXPECT_LT(reach_m(site, spec), 1.02 * measured.farthest_m);
}

// Uses grids whose centers are away from the site, in all directions.
TEST(FrameLadder, TheBoundOfEachRungHoldsForWholeGridsAndIsTight) {
    double longitude_deg = -97.3;
    for (const double latitude_deg : {78.0, 65.0, 45.0, 35.0, 2.0, -30.0, -71.0}) {
        longitude_deg = longitude_deg == 180 ? -97.3 : 180;
        for (const Projection projection :
             {Projection::azimuthal_equidistant, Projection::latitude_longitude,
              Projection::lambert_conformal}) {
            for (const double extent_m : {2e4, 1e5, 6e5}) {
                const GridSpec spec = about({latitude_deg, longitude_deg}, projection, extent_m);
                const SitePosition site{"XXXX", latitude_deg + extent_m / 30e5,
                                        longitude_deg - extent_m / 30e5, 0};
                for (const FrameKind kind :
                     {FrameKind::sphere, FrameKind::table, FrameKind::geodesic}) {
                    SCOPED_TRACE(fmt::format("{} {} {} {}", frame_kind_name(kind),
                                             projection_name(projection), latitude_deg, extent_m));
                    expect_bound(site, spec, kind);
                }
            }
        }
    }
}

TEST(FrameLadder, AGridAboutItsSiteIsClosedFormOnEveryRung) {
    const SitePosition site{"KTLX", 35.3333, -97.2778, 389};
    const GridSpec spec = about({35.3333, -97.2778}, Projection::azimuthal_equidistant, 6e5);
    for (const FrameKind kind : {FrameKind::sphere, FrameKind::table, FrameKind::geodesic}) {
        const auto geometry = make_column_geometry(site, spec, kind);
        ASSERT_TRUE(geometry);
        const double bound_m = frame_error_bound_m(kind, site, spec);
        EXPECT_EQ(bound_m, storage_error_bound_m(reach_m(site, spec)));
        const Measured measured = measure(**geometry);
        EXPECT_LE(measured.worst_m, bound_m);
        EXPECT_LT(bound_m, 2 * measured.worst_m);
    }
}

TEST(FrameLadder, AGridThatHoldsTheAntipodeReachesIt) {
    const GridSpec spec = about({-35, 83}, Projection::latitude_longitude, 6e5);
    EXPECT_EQ(reach_m({"XXXX", 35, -97, 0}, spec), 20003931.5);
    EXPECT_LT(reach_m({"XXXX", 35, -90, 0}, spec), 20003931.5);
}

}  // namespace
}  // namespace stormcellar::grid

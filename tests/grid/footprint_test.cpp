// Tests that the outlines of neighboring cells fit together, for all projections, sites and cells.
#include "grid/place/footprint.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/site_frame.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::grid {
namespace {

// A vector in the plane of azimuth and arc about the site.
struct Vector {
    double x = 0, y = 0;
};
Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y};
}
Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y};
}
Vector operator*(double factor, Vector a) {
    return {factor * a.x, factor * a.y};
}
double cross(Vector a, Vector b) {
    return a.x * b.y - a.y * b.x;
}

// The center and the sides of a footprint, computed from the definition of u and v in
// grid/place/footprint.h.
struct Outline {
    Vector center, u, v;
};
Outline outline_of(const Footprint& footprint) {
    const double azimuth = static_cast<double>(footprint.azimuth_deg) * M_PI / 180;
    const auto arc_m = static_cast<double>(footprint.arc_m);
    const Vector along{std::sin(azimuth), std::cos(azimuth)};
    const Vector across{std::cos(azimuth), -std::sin(azimuth)};
    const Vector du{static_cast<double>(footprint.u_along),
                    static_cast<double>(footprint.u_across)};
    const Vector dv{static_cast<double>(footprint.v_along),
                    static_cast<double>(footprint.v_across)};
    const double inverse = 1 / cross(du, dv);
    return {arc_m * along, inverse * (dv.y * along - dv.x * across),
            inverse * (du.x * across - du.y * along)};
}

// Returns the area between two sides that should coincide, as a share of the cell's area.
double between(const Outline& a, Vector a_from, Vector a_to, Vector b_from, Vector b_to) {
    const Vector side = a_to - a_from;
    const double area =
        (std::abs(cross(b_from - a_from, side)) + std::abs(cross(b_to - a_to, side))) / 2;
    return area / std::abs(cross(a.u, a.v));
}

double worst_of(const SitePosition& site, const GridSpec& spec) {
    const auto geometry = make_column_geometry(site, spec);
    EXPECT_TRUE(geometry);
    double worst = 0;
    const auto outline = [&](int ix, int iy) {
        return outline_of(footprint_of(**geometry, ix, iy));
    };
    for (int iy = 0; iy + 1 < spec.ny; ++iy) {
        for (int ix = 0; ix + 1 < spec.nx; ++ix) {
            const Outline here = outline(ix, iy);
            if (std::hypot(here.center.x, here.center.y) > 460e3) continue;
            const Outline east = outline(ix + 1, iy);
            const Outline north = outline(ix, iy + 1);
            const Vector e = here.center + 0.5 * here.u;
            const Vector w = east.center - 0.5 * east.u;
            worst = std::max(worst, between(here, e - 0.5 * here.v, e + 0.5 * here.v,
                                            w - 0.5 * east.v, w + 0.5 * east.v));
            const Vector n = here.center + 0.5 * here.v;
            const Vector s = north.center - 0.5 * north.v;
            worst = std::max(worst, between(here, n - 0.5 * here.u, n + 0.5 * here.u,
                                            s - 0.5 * north.u, s + 0.5 * north.u));
        }
    }
    return worst;
}

GridSpec spec_of(Projection projection, GeoPoint center, double spacing_m) {
    GridSpec spec = default_spec(center.latitude_deg, center.longitude_deg);
    spec.projection = projection;
    spec.spacing_m = spacing_m;
    spec.nx = spec.ny = static_cast<int>(std::clamp(900e3 / spacing_m, 4.0, 90.0));
    if (projection == Projection::latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = spacing_m / 111e3;
    }
    if (projection == Projection::lambert_conformal) {
        spec.parallels_deg = {center.latitude_deg - 4, center.latitude_deg + 6};
    }
    return spec;
}

TEST(Footprint, NeighboursLeaveAndShareLessThanAThousandthOfACell) {
    const std::vector<SitePosition> sites = {{"AA", 78, 15, 0},
                                             {"BB", 0, -3, 0},
                                             {"CC", -71, -180, 0},
                                             {"DD", 35, -97, 390},
                                             {"EE", 52, 180, 0}};
    for (const SitePosition& site : sites) {
        const SiteFrame frame(site.latitude_deg, site.longitude_deg);
        for (const double arc_m : {0.0, 30e3, 230e3, 440e3}) {
            const GeoPoint center = frame.to_geo({222, arc_m});
            for (const Projection projection :
                 {Projection::azimuthal_equidistant, Projection::latitude_longitude,
                  Projection::lambert_conformal}) {
                for (const double spacing_m : {500.0, 1000.0, 4000.0, 10000.0}) {
                    const GridSpec spec = spec_of(projection, center, spacing_m);
                    double most = 1e-3;
                    if (projection == Projection::latitude_longitude) {
                        // Parallels, and rows of equal degrees, shorten toward the poles.
                        const double edge_deg =
                            std::abs(center.latitude_deg) + spec.ny * spec.spacing_deg / 2;
                        most += spacing_m / 6371e3 * std::tan(edge_deg * M_PI / 180);
                    }
                    EXPECT_LT(worst_of(site, spec), most)
                        << site.latitude_deg << " " << arc_m << " " << projection_name(projection)
                        << " " << spacing_m;
                }
            }
        }
    }
}

// The cell of a grid with one column must be a square of the spacing, turned as the site sees it.
TEST(Footprint, OfASingleColumnIsASquareOfItsSpacing) {
    const SitePosition site{"AA", 35, -97, 0};
    GridSpec spec = square_spec(35.5, -96.2, 1, 2000);
    const auto geometry = make_column_geometry(site, spec);
    ASSERT_TRUE(geometry);
    const Outline outline = outline_of(footprint_of(**geometry, 0, 0));
    EXPECT_NEAR(outline.u.x, 2000, 0.1);
    EXPECT_NEAR(outline.u.y, 0, 0.1);
    EXPECT_NEAR(outline.v.x, 0, 0.1);
    EXPECT_NEAR(outline.v.y, 2000, 0.1);
    EXPECT_NEAR(footprint_of(**geometry, 0, 0).radius_m, 1000 * std::sqrt(2), 0.1);
}

// The centers of all other cells must be outside, and the cell's own center inside.
TEST(Footprint, HoldsItsOwnCentreAlone) {
    const SitePosition site{"AA", 35, -97, 0};
    GridSpec spec = spec_of(Projection::lambert_conformal, {36, -95}, 3000);
    spec.nx = spec.ny = 7;
    const auto geometry = make_column_geometry(site, spec);
    ASSERT_TRUE(geometry);
    const Outline middle = outline_of(footprint_of(**geometry, 3, 3));
    for (int iy = 0; iy < 7; ++iy) {
        for (int ix = 0; ix < 7; ++ix) {
            const Outline other = outline_of(footprint_of(**geometry, ix, iy));
            const Vector off = other.center - middle.center;
            const double area = cross(middle.u, middle.v);
            EXPECT_NEAR(cross(off, middle.v) / area, ix - 3, 0.01);
            EXPECT_NEAR(cross(middle.u, off) / area, iy - 3, 0.01);
        }
    }
}

}  // namespace
}  // namespace stormcellar::grid

// Tests gridding with the most difficult places of columns and cells, and the most difficult
// azimuths. Each test has the name of its hazard, and compares the grid with a closed form or with
// the oracle.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"
#include "tests/hard_cases/grid_case.h"

namespace stormcellar::grid {
namespace {

// ---- Every stratum: sites, elevations and ranges of the domain

struct Stratum {
    SitePosition site;
    double elevation_deg;
};

class EveryStratum : public ::testing::TestWithParam<Stratum> {};

// A grid of one cell at the center of a gate must hold that gate. A closed form and the geodesic
// give the place of the cell; codes of 16 bits distinguish gates and radials.
TEST_P(EveryStratum, ACellAtAGatesCentreHoldsTheGate) {
    const auto& [site, elevation_deg] = GetParam();
    SweepPlan plan;
    plan.elevation_deg = elevation_deg;
    plan.gates = 1881;
    plan.gate_spacing_m = 250;
    plan.first_gate_m = -1;
    plan.word_size_bits = 16;
    plan.code = [](int radial, int gate) {
        return static_cast<std::uint16_t>(100 + radial % 25 * 2000 + gate);
    };
    GridCase given;
    given.volume = make_volume({plan});
    given.site = site;
    const BeamGeometry beam(site.latitude_deg, site.altitude_m);
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    int compared = 0;
    for (const int gate : {1, 2, 4, 40, 400, 919, 1880}) {
        // A Radial holds its elevation as a float.
        const auto measured_deg = static_cast<double>(static_cast<float>(elevation_deg));
        const EarthPoint point = beam.forward({250.0 * gate - 1, measured_deg});
        if (point.height_m < -900 || point.height_m > 59e3) continue;
        for (const int radial : {0, 90, 222, 359}) {
            const GeoPoint place = frame.to_geo({radial + 0.5, point.arc_m});
            given.spec = plane_about({"", place.latitude_deg, place.longitude_deg, 0}, 1, 1000, {});
            given.spec.levels_m = {point.height_m};
            for (const Method& method :
                 {method_of(Interpolation::nearest), method_of(Interpolation::linear)}) {
                const Grid grid = grid_of(given, method, -1e5, 1e5);
                ASSERT_EQ(grid.status.size(), 1U);
                ASSERT_EQ(grid.status[0], CellStatus::value) << gate << " " << radial;
                const double code = static_cast<double>(grid.values[0]) * 2 + 66;
                EXPECT_EQ(code, 100 + radial % 25 * 2000 + gate) << gate << " " << radial;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 20);
}

std::vector<Stratum> strata() {
    const std::vector<SitePosition> sites = {
        {"AA", 78, 15, 100},     {"BB", 0, 0, -100}, {"CC", -71, -2, 4000},    {"DD", 52, 180, 30},
        {"EE", -17, -180, 4000}, {"FF", 90, 0, 10},  {"GG", 13.45, 144.8, 264}};
    std::vector<Stratum> all;
    for (const SitePosition& site : sites) {
        for (const double elevation_deg : {-5.0, -0.5, 0.0, 0.5, 19.5, 60.0})
            all.push_back({site, elevation_deg});
    }
    return all;
}
INSTANTIATE_TEST_SUITE_P(SitesAndElevations, EveryStratum, ::testing::ValuesIn(strata()));

// ---- Azimuths

// The sweeps have the same echo, but begin at different azimuths.
TEST(AzimuthWrap, WhereTheFirstRadialStandsDoesNotMatter) {
    std::map<std::string, Grid> first;
    for (const double from_deg : {0.5, 200.5, 359.5}) {
        std::vector<SweepPlan> plans = {patchy_plan(0.5, 1), patchy_plan(1.5, 2)};
        for (SweepPlan& plan : plans) {
            plan.first_azimuth_deg = from_deg;
            plan.code = [from_deg](int radial, int gate) {
                return patchy_code(std::fmod(from_deg + radial, 360), 1000.0 * gate);
            };
        }
        const GridCase given = about(plains, plans);
        expect_sound_by_every_method(given, {}, [&](const Method& method, const Grid& grid) {
            const auto [at, is_first] = first.emplace(label(method), grid);
            if (is_first) return;
            const bool sums_in_another_order = method.cell == CellExtent::area;
            EXPECT_EQ(at->second.status, grid.status) << label(method) << " " << from_deg;
            for (std::size_t i = 0; i < grid.values.size(); ++i) {
                if (grid.status[i] != CellStatus::value) continue;
                ASSERT_NEAR(at->second.values[i], grid.values[i], sums_in_another_order ? 1e-3 : 0)
                    << label(method) << " " << from_deg;
            }
        });
    }
}

// Returns sweeps whose radials go clockwise from `from_deg` over 360 - `gap_deg` degrees.
std::vector<SweepPlan> with_gap(double from_deg, double gap_deg) {
    std::vector<SweepPlan> plans = {patchy_plan(0.5, 1), patchy_plan(1.5, 2)};
    for (SweepPlan& plan : plans) {
        plan.first_azimuth_deg = from_deg;
        plan.radials = static_cast<int>(360 - gap_deg);
        plan.code = [](int, int) { return ref_code(30); };
    }
    return plans;
}

double azimuth_of(const GridSpec& spec, int ix, int iy) {
    return SiteFrame::from_plane(spec.x_m(ix), spec.y_m(iy)).azimuth_deg;
}

// The test uses ranges of 60 to 140 km, where the beams surely see the level of 2 km.
TEST(AzimuthGap, WhatLiesInsideIsNotSeenWhateverTheMethodAcrossNorthToo) {
    struct Gap {
        double from_deg, width_deg;
    };
    for (const Gap gap : {Gap{95.5, 100}, Gap{350.5, 20}, Gap{358.5, 3}, Gap{179.5, 350}}) {
        const GridCase given =
            about(plains, with_gap(std::fmod(gap.from_deg + gap.width_deg, 360), gap.width_deg));
        expect_sound_by_every_method(given, {}, [&](const Method& method, const Grid& grid) {
            const GridSpec& spec = grid.spec;
            int inside = 0, outside = 0;
            for (int iy = 0; iy < spec.ny; ++iy) {
                for (int ix = 0; ix < spec.nx; ++ix) {
                    const double arc_m = std::hypot(spec.x_m(ix), spec.y_m(iy));
                    if (arc_m < 60e3 || arc_m > 140e3) continue;
                    const double into_deg =
                        std::fmod(azimuth_of(spec, ix, iy) - gap.from_deg + 360, 360);
                    // The outline of an area extends up to 3.4 degrees to both sides.
                    const double edge_deg = method.cell == CellExtent::area ? 3.6 : 0.6;
                    const CellStatus status = grid.status[spec.index(ix, iy, 3)];  // 2 km
                    if (into_deg > edge_deg && into_deg < gap.width_deg - 1 - edge_deg) {
                        ASSERT_EQ(status, CellStatus::not_seen) << label(method) << " " << into_deg;
                        ++inside;
                    } else if (into_deg > gap.width_deg - 1 + edge_deg &&
                               into_deg < 360 - edge_deg) {
                        if (arc_m < 80e3 || arc_m > 120e3) continue;
                        ASSERT_EQ(status, CellStatus::value) << label(method) << " " << into_deg;
                        ++outside;
                    }
                }
            }
            EXPECT_GT(inside + outside, 100);
        });
    }
}

TEST(AzimuthDuplicatesAndLosses, AgreeWithTheOracle) {
    GridCase given = about(plains, {patchy_plan(0.5, 1), patchy_plan(1.5, 2)});
    for (level2::Sweep& sweep : given.volume.sweeps) {
        std::vector<level2::Radial>& radials = sweep.radials;
        radials[20].azimuth_deg = radials[21].azimuth_deg;  // one azimuth twice, and one lost
        radials[100].azimuth_deg = radials[101].azimuth_deg = radials[102].azimuth_deg;
        radials[359].azimuth_deg = 360;  // north, written as 360 and not as 0
        radials[200].azimuth_deg = -159.5F;
        for (std::size_t i = 240; i < 260; i += 3)
            sweep.moments[0].gate_counts[i] = 0;                       // lost for this moment
        std::swap(radials[50].azimuth_deg, radials[300].azimuth_deg);  // out of order
    }
    expect_sound_by_every_method(given);
}

// ---- Places

TEST(Poles, AGridOverThePoleFromASiteAt78North) {
    const SitePosition svalbard{"XXXX", 78, 15.5, 440};
    GridCase given = about(svalbard, {patchy_plan(0.5, 1), patchy_plan(1.5, 2)}, 45, 7000);
    for (level2::Sweep& sweep : given.volume.sweeps) {
        sweep.moments[0].gate_spacing_m = 10000;  // to the pole, 1336 km away, and beyond
        sweep.moments[0].gate_stride = 150;
    }
    given.spec.levels_m = {20e3, 40e3, 50e3, 60e3};
    for (const double latitude_deg : {86.0, 90.0}) {
        given.spec.center_latitude_deg = latitude_deg;
        given.spec.spacing_m = 20000;
        int values = 0;
        expect_sound_by_every_method(given, {}, [&](const Method&, const Grid& grid) {
            values += static_cast<int>(
                std::count(grid.status.begin(), grid.status.end(), CellStatus::value));
        });
        EXPECT_GT(values, 0) << latitude_deg;
    }
}

GridSpec on_projection(GridSpec spec, Projection projection) {
    spec.projection = projection;
    if (projection == Projection::latitude_longitude) {
        spec.spacing_deg = spec.spacing_m / 100e3;
        spec.spacing_m = 0;
    }
    if (projection == Projection::lambert_conformal) {
        const double latitude_deg = spec.center_latitude_deg;
        spec.parallels_deg = {latitude_deg - 3, latitude_deg + 4};
    }
    return spec;
}

TEST(Antimeridian, EveryProjectionAtGuamAlaskaAnd180EastAndWest) {
    const std::vector<std::pair<SitePosition, GeoPoint>> places = {
        {{"PGUA", 13.4559, 144.8111, 110}, {13.2, 145.3}},
        {{"PAEC", 64.5114, -165.2949, 28}, {64.9, -166.2}},
        {{"XXXX", -17.5, 180, 60}, {-17.3, -179.6}},
        {{"XXXX", 52, -180, 60}, {52.1, 179.8}},
        {{"XXXX", 70, 179.9, 4000}, {70, -179.9}}};
    for (const auto& [site, center] : places) {
        for (const Projection projection :
             {Projection::azimuthal_equidistant, Projection::latitude_longitude,
              Projection::lambert_conformal}) {
            GridCase given = about(site, {patchy_plan(0.5, 1), patchy_plan(1.5, 2)}, 45, 6000);
            given.spec.center_latitude_deg = center.latitude_deg;
            given.spec.center_longitude_deg = center.longitude_deg;
            given.spec = on_projection(given.spec, projection);
            SCOPED_TRACE(::testing::Message() << site.latitude_deg << " " << site.longitude_deg
                                              << " " << projection_name(projection));
            expect_sound_by_every_method(given);
        }
    }
}

TEST(Antimeridian, TheSameMeridianSaidEastOrWestGivesTheSameBits) {
    GridCase east = about({"XXXX", 52, 180, 60}, {patchy_plan(0.5, 1), patchy_plan(1.5, 2)});
    GridCase west = east;
    west.site.longitude_deg = -180;
    for (const double center_deg : {179.3, -179.3}) {
        east.spec.center_longitude_deg = west.spec.center_longitude_deg = center_deg;
        for (const Projection projection :
             {Projection::azimuthal_equidistant, Projection::lambert_conformal}) {
            GridCase one = east;
            GridCase other = west;
            one.spec = other.spec = on_projection(east.spec, projection);
            const Grid a = grid_of(one, Method{});
            const Grid b = grid_of(other, Method{});
            EXPECT_EQ(a.status, b.status) << center_deg;
            EXPECT_EQ(a.values, b.values) << center_deg;
        }
    }
}

// ---- Cells and levels

TEST(TinyAndHugeCells, OneMetreAndAHundredKilometres) {
    const std::vector<SweepPlan> plans = {patchy_plan(0.5, 1), patchy_plan(1.5, 2)};
    GridCase tiny = about(plains, plans, 33, 1);
    const GeoPoint there = SiteFrame(plains.latitude_deg, plains.longitude_deg)
                               .to_geo({33.5, 80e3});  // where four gates meet
    tiny.spec.center_latitude_deg = there.latitude_deg;
    tiny.spec.center_longitude_deg = there.longitude_deg;
    tiny.spec.levels_m = {1500, 1501, 1502};
    // Either all cells are doubtful, because they are within 0.25 m of another gate, or no cell is
    // doubtful. So allow all cells to be doubtful.
    expect_sound_by_every_method(tiny, {1, 1});
    GridCase huge = about(plains, plans, 3, 100e3);
    huge.spec.center_latitude_deg += 0.13;  // away from the borders of radials
    huge.spec.center_longitude_deg += 0.21;
    Agreement agreement;
    agreement.area_tolerance = 2;  // outlines are computed for their centers
    agreement.most_doubtful = 0.5;
    expect_sound_by_every_method(huge, agreement);
}

TEST(LevelsBelowAndAboveEverything, AreNotSeen) {
    GridCase given = about(plains, {patchy_plan(0.5, 1), patchy_plan(1.5, 2)});
    for (const std::vector<double>& levels_m :
         {std::vector<double>{-1000, -500}, std::vector<double>{40e3, 60e3}}) {
        given.spec.levels_m = levels_m;
        expect_sound_by_every_method(given, {}, [](const Method& method, const Grid& grid) {
            EXPECT_EQ(std::count(grid.status.begin(), grid.status.end(), CellStatus::not_seen),
                      static_cast<std::ptrdiff_t>(grid.status.size()))
                << label(method);
        });
    }
}

// A level is exactly as high as a beam, where the interval between two beams ends and the next
// begins.
TEST(LevelsAtABeamsHeight, HoldThatBeamAndDivideByNothing) {
    std::vector<SweepPlan> plans = plans_at({0.5, 1.5, 2.5}, patchy_plan());
    for (SweepPlan& plan : plans) {
        const double dbz = 10 + 10 * plan.elevation_deg;
        plan.code = [dbz](int, int) { return ref_code(dbz); };
    }
    const BeamGeometry beam(plains.latitude_deg, plains.altitude_m);
    GridCase given;
    given.site = plains;
    given.volume = make_volume(plans);
    // The grid has one column, 100 km east of the site, where the gridder's tables have a node.
    const GeoPoint there =
        SiteFrame(plains.latitude_deg, plains.longitude_deg).to_geo({90.5, 100e3});
    given.spec = plane_about({"", there.latitude_deg, there.longitude_deg, 0}, 1, 1000, {});
    for (const SweepPlan& plan : plans) {
        const double exact_m = beam.over(100e3, plan.elevation_deg).height_m;
        // The levels are the float nearest to this height and the two floats beside it; the gridder
        // uses one of the three.
        const auto height_m = static_cast<float>(exact_m);
        given.spec.levels_m = {static_cast<double>(std::nextafter(height_m, 0.0F)),
                               static_cast<double>(height_m),
                               static_cast<double>(std::nextafter(height_m, 1e9F))};
        for (const Method& method : all_methods()) {
            if (method.cell == CellExtent::area) continue;
            const Grid grid = grid_of(given, method);
            for (std::size_t i = 0; i < 3; ++i) {
                ASSERT_EQ(grid.status[i], CellStatus::value) << label(method);
                const bool alone = method.interpolation != Interpolation::beam_weighted;
                EXPECT_NEAR(grid.values[i], 10 + 10 * plan.elevation_deg, alone ? 0.01 : 0.3)
                    << label(method);
            }
        }
    }
}

}  // namespace
}  // namespace stormcellar::grid

#include "stormcellar/grid/gridder.h"

#include <cmath>
#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/column_geometry.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const SitePosition ktlx{"KTLX", 35.3333, -97.2778, 389};

SweepPlan plan(double elevation_deg, int cut, double dbz = 20) {
    SweepPlan made;
    made.elevation_deg = elevation_deg;
    made.cut = cut;
    made.code = [dbz](int, int) { return ref_code(dbz); };
    return made;
}

Grid make(const level2::Volume& volume, int threads = 1) {
    GridSpec spec = default_spec(ktlx.latitude_deg, ktlx.longitude_deg);
    spec.spacing_m = 5000;
    spec.nx = spec.ny = 121;  // 600 km across, with column 60 at the site
    const auto geometry = make_column_geometry(ktlx, spec);
    EXPECT_TRUE(geometry);
    auto grid = make_grid(volume, ktlx, **geometry, {level2::Moment::ref, 0.95, threads, {}, {}});
    EXPECT_TRUE(grid);
    return grid ? *grid : Grid{};
}

CellStatus status_at(const Grid& grid, double x_km, double y_km, double z_km) {
    const int ix = 60 + static_cast<int>(std::lround(x_km / 5));
    const int iy = 60 + static_cast<int>(std::lround(y_km / 5));
    const int iz = static_cast<int>(std::lround(z_km / 0.5)) - 1;
    return grid.status[grid.spec.index(ix, iy, iz)];
}

float value_at(const Grid& grid, double x_km, double y_km, double z_km) {
    const int ix = 60 + static_cast<int>(std::lround(x_km / 5));
    const int iy = 60 + static_cast<int>(std::lround(y_km / 5));
    const int iz = static_cast<int>(std::lround(z_km / 0.5)) - 1;
    return grid.values[grid.spec.index(ix, iy, iz)];
}

TEST(Gridder, NorthIsUpAndEastIsRight) {
    SweepPlan quadrants = plan(0.5, 1);
    quadrants.code = [](int radial, int) {
        const int quadrant = 1 + radial / 90;
        return ref_code(10 * quadrant);
    };
    const Grid grid = make(make_volume({quadrants}));
    EXPECT_EQ(value_at(grid, 50, 50, 1), 10) << "north-east";
    EXPECT_EQ(value_at(grid, 50, -50, 1), 20) << "south-east";
    EXPECT_EQ(value_at(grid, -50, -50, 1), 30) << "south-west";
    EXPECT_EQ(value_at(grid, -50, 50, 1), 40) << "north-west";
}

TEST(Gridder, TheConeOfSilenceIsNotSeen) {
    const Grid grid = make(make_volume({plan(0.5, 1), plan(10, 2), plan(19.5, 3)}));
    EXPECT_EQ(status_at(grid, 0, 0, 0.5), CellStatus::not_seen)
        << "no beam sees the air over the antenna";
    EXPECT_EQ(status_at(grid, 0, 0, 10), CellStatus::not_seen);
    EXPECT_EQ(status_at(grid, 10, 0, 3), CellStatus::value);
    EXPECT_EQ(status_at(grid, 10, 0, 5), CellStatus::not_seen);
    EXPECT_EQ(status_at(grid, 30, 0, 10), CellStatus::value);
}

TEST(Gridder, BelowTheLowestBeamIsNotSeen) {
    const Grid grid = make(make_volume({plan(0.5, 1), plan(1.5, 2)}));
    // At 250 km, the lower edge of the 0.5 degree beam is near 4.1 km.
    EXPECT_EQ(status_at(grid, 250, 0, 3.5), CellStatus::not_seen);
    EXPECT_EQ(status_at(grid, 250, 0, 4.5), CellStatus::value);
    EXPECT_EQ(status_at(grid, 50, 0, 0.5), CellStatus::not_seen) << "the beam's edge is near 560 m";
    EXPECT_EQ(status_at(grid, 50, 0, 1), CellStatus::value);
}

TEST(Gridder, BeyondTheLastGateIsNotSeen) {
    const Grid grid = make(make_volume({plan(0.5, 1), plan(1.5, 2)}));
    EXPECT_EQ(status_at(grid, 295, 0, 7), CellStatus::value);
    EXPECT_EQ(status_at(grid, 300, 0, 7), CellStatus::not_seen);
    EXPECT_EQ(status_at(grid, 215, 215, 7.5), CellStatus::not_seen);
}

TEST(Gridder, AGapInAzimuthIsNotSeen) {
    SweepPlan low = plan(0.5, 1);
    low.radials = 270;  // no radials between 270 and 360 degrees
    SweepPlan high = low;
    high.elevation_deg = 1.5;
    high.cut = 2;
    const Grid grid = make(make_volume({low, high}));
    EXPECT_EQ(status_at(grid, -100, 100, 2), CellStatus::not_seen);
    EXPECT_EQ(status_at(grid, -100, -100, 2), CellStatus::value);
    EXPECT_EQ(status_at(grid, 100, 100, 2), CellStatus::value);
}

TEST(Gridder, RangeFoldedAndNoEchoStayApart) {
    SweepPlan low = plan(0.5, 1);
    low.code = [](int radial, int) { return radial < 180 ? range_folded : below_threshold; };
    SweepPlan high = low;
    high.elevation_deg = 1.5;
    high.cut = 2;
    const Grid grid = make(make_volume({low, high}));
    EXPECT_EQ(status_at(grid, 100, 0, 2), CellStatus::range_folded);
    EXPECT_EQ(status_at(grid, -100, 0, 2), CellStatus::no_echo);
}

TEST(Gridder, AMissingCutIsNotBridged) {
    level2::Volume volume = make_volume({plan(0.5, 1), plan(1.45, 2), plan(4.3, 5)});
    EXPECT_EQ(status_at(make(volume), 100, 0, 5.5), CellStatus::value);
    volume.vcp = 21;
    const Grid grid = make(volume);
    EXPECT_EQ(status_at(grid, 100, 0, 5.5), CellStatus::not_seen);
    EXPECT_EQ(status_at(grid, 100, 0, 2), CellStatus::value) << "0.5 and 1.45 are neighbors";
    EXPECT_EQ(status_at(grid, 100, 0, 8.5), CellStatus::value) << "within the 4.3 degree beam";
    ASSERT_EQ(grid.provenance.notes.size(), 1U);
    EXPECT_NE(grid.provenance.notes[0].find("missing above 1.45"), std::string::npos);
}

TEST(Gridder, ValuesAreLinearInHeightBetweenBeams) {
    const Grid grid = make(make_volume({plan(0.5, 1, 10), plan(1.5, 2, 30)}));
    const BeamGeometry beam(ktlx.latitude_deg, ktlx.altitude_m);
    const double low_m = beam.over(150e3, 0.5).height_m;
    const double high_m = beam.over(150e3, 1.5).height_m;
    const double expected = 10 + 20 * (4000 - low_m) / (high_m - low_m);
    EXPECT_NEAR(value_at(grid, 150, 0, 4), expected, 1e-3);
}

TEST(Gridder, NoEchoEntersAValueAtTheDetectionLimit) {
    SweepPlan quiet = plan(1.5, 2);
    quiet.code = [](int, int) { return below_threshold; };
    const Grid grid = make(make_volume({plan(0.5, 1, 30), quiet}));
    const BeamGeometry beam(ktlx.latitude_deg, ktlx.altitude_m);
    const auto low = beam.over(150e3, 0.5);
    const auto high = beam.over(150e3, 1.5);
    const double weight = (4000 - low.height_m) / (high.height_m - low.height_m);
    ASSERT_LT(weight, 0.5);
    const double limit_dbz = -41.5 + 20 * std::log10(150);
    EXPECT_EQ(status_at(grid, 150, 0, 4), CellStatus::value);
    EXPECT_NEAR(value_at(grid, 150, 0, 4), 30 * (1 - weight) + limit_dbz * weight, 0.05);
    EXPECT_EQ(status_at(grid, 150, 0, 5), CellStatus::no_echo);
}

TEST(Gridder, EqualElevationsAndASingleSweep) {
    level2::Volume volume = make_volume({plan(0.5, 1), plan(1.5, 2)});
    volume.sweeps[0].vcp_elevation_deg = 0.5F;
    volume.sweeps[1].vcp_elevation_deg = 0.9F;
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.elevation_deg = 0.5F;  // make the cut have the same elevation
    const Grid grid = make(volume);
    for (const float value : grid.values)
        ASSERT_TRUE(std::isfinite(value));
    EXPECT_EQ(status_at(grid, 100, 0, 2), CellStatus::value);
    const Grid single = make(make_volume({plan(0.5, 1)}));
    EXPECT_EQ(status_at(single, 100, 0, 2), CellStatus::value);
    EXPECT_EQ(status_at(single, 100, 0, 3.5), CellStatus::not_seen);
}

// One sector of the upper sweep is measured below the lower sweep, so the two change places there.
TEST(Gridder, ReversedElevationsOfSomeRadialsAreSorted) {
    level2::Volume volume = make_volume({plan(0.5, 1, 10), plan(0.9, 2, 30), plan(2.4, 3, 30)});
    for (std::size_t i = 0; i < 60; ++i) {
        volume.sweeps[0].radials[i].elevation_deg = 0.8F;
        volume.sweeps[1].radials[i].elevation_deg = 0.6F;
    }
    const Grid grid = make(volume);
    const BeamGeometry beam(ktlx.latitude_deg, ktlx.altitude_m);
    const double arc_m = std::hypot(75e3, 130e3);
    const auto expected = [&](double low_deg, double high_deg, double low, double high) {
        const double low_m = beam.over(arc_m, low_deg).height_m;
        const double high_m = beam.over(arc_m, high_deg).height_m;
        return low + (high - low) * (3500 - low_m) / (high_m - low_m);
    };
    ASSERT_LT(beam.over(arc_m, 0.6).height_m, 3500);
    ASSERT_GT(beam.over(arc_m, 0.8).height_m, 3500);
    EXPECT_NEAR(value_at(grid, 75, 130, 3.5), expected(0.6, 0.8, 30, 10), 0.05)
        << "the sweeps have changed places";
    EXPECT_NEAR(value_at(grid, -75, 130, 3.5), expected(0.5, 0.9, 10, 30), 0.05);
}

// Regression of 2026-11-21: where sweeps changed places, the plan of a tile lacked a sweep beside a
// cell. Cells that were not seen then became no echo. Here, every second radial is above or below
// the elevation of its sweep.
TEST(Gridder, SweepsThatChangePlacesAreAllLookedAt) {
    std::vector<SweepPlan> plans;
    for (const double elevation_deg : {0.5, 0.9, 1.3, 1.7, 2.1}) {
        SweepPlan sweep = plan(elevation_deg, static_cast<int>(plans.size()) + 1);
        const bool is_empty = plans.size() == 2;
        sweep.code = [](int, int) { return below_threshold; };
        if (is_empty) sweep.gates = 100;  // ends before the others
        plans.push_back(sweep);
    }
    level2::Volume volume = make_volume(plans);
    for (level2::Sweep& sweep : volume.sweeps) {
        for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
            const float off_deg = i % 4 == 1 ? 0.45F : i % 4 == 3 ? -0.45F : 0;
            const bool flipped = sweep.elevation_number % 2 == 0;
            sweep.radials[i].elevation_deg += flipped ? -off_deg : off_deg;
        }
    }
    // Put a folded gate into every stretch, so that no sweep is uniform and every sweep is sampled.
    level2::Volume sampled = volume;
    for (level2::Sweep& sweep : sampled.sweeps) {
        for (std::size_t at = 0; at < sweep.moments[0].codes8.size(); at += 16)
            sweep.moments[0].codes8[at] = 1;
    }
    const Grid quick = make(volume);
    const Grid slow = make(sampled);
    std::size_t differing = 0;
    for (std::size_t cell = 0; cell < quick.status.size(); ++cell) {
        const bool seen = quick.status[cell] != CellStatus::not_seen;
        differing += seen != (slow.status[cell] != CellStatus::not_seen) ? 1 : 0;
    }
    EXPECT_EQ(differing, 0U);
}

TEST(Gridder, SaysWhatItDid) {
    level2::Volume volume = make_volume({plan(0.5, 1), plan(1.5, 2), plan(0.5, 3)});
    volume.vcp = 212;
    const Grid grid = make(volume);
    EXPECT_EQ(grid.time, volume.sweeps[0].radials[0].time);
    EXPECT_EQ(grid.start_time, volume.sweeps[1].radials[0].time) << "the first sweep was repeated";
    EXPECT_EQ(grid.end_time, volume.sweeps[2].radials.back().time);
    EXPECT_EQ(grid.provenance.method, "column-linear");
    EXPECT_EQ(grid.provenance.averaging, "dBZ");
    EXPECT_EQ(grid.provenance.vcp, 212);
    ASSERT_EQ(grid.sites.size(), 1U);
    EXPECT_EQ(grid.sites[0].icao, "KTLX");
}

TEST(Gridder, RefusesWhatMakesNoSense) {
    const level2::Volume volume = make_volume({plan(0.5, 1)});
    const auto geometry =
        make_column_geometry(ktlx, default_spec(ktlx.latitude_deg, ktlx.longitude_deg));
    const auto code = [&](const level2::Volume& v, const SitePosition& at, GridderOptions options) {
        const auto grid = make_grid(v, at, **geometry, options);
        return grid ? ErrorCode::internal : grid.error().code;
    };
    EXPECT_EQ(code({}, ktlx, {}), ErrorCode::not_found);
    EXPECT_EQ(code(volume, ktlx, {level2::Moment::vel, 0, 1, {}, {}}), ErrorCode::not_found);
    EXPECT_EQ(code(volume, {"KLOT", 41.6, -88.1, 200}, {}), ErrorCode::bad_argument);
    EXPECT_EQ(code(volume, ktlx, {level2::Moment::ref, -1, 1, {}, {}}), ErrorCode::bad_argument);
    EXPECT_EQ(code(volume, ktlx, {level2::Moment::ref, std::nan(""), 1, {}, {}}),
              ErrorCode::bad_argument);
    EXPECT_EQ(code(volume, ktlx, {level2::Moment::ref, 0, 0, {}, {}}), ErrorCode::bad_argument);
}

// 2026-11-30: classes were not gridded at all.
TEST(Gridder, ClassesComeFromTheNearestGate) {
    SweepPlan classes = plan(0.5, 1);
    classes.moment = level2::Moment::hca;
    classes.code = [](int radial, int gate) {  // 40, dry snow, and 60, rain
        return static_cast<std::uint16_t>((radial / 3 + gate / 5) % 2 == 0 ? 6 : 8);
    };
    SweepPlan above = classes;
    above.elevation_deg = 1.5;
    above.cut = 2;
    level2::Volume volume = make_volume({classes, above});
    for (level2::Sweep& sweep : volume.sweeps) {
        sweep.moments[0].scale = 0.1F;
        sweep.moments[0].offset = 2;
    }
    const auto geometry =
        *make_column_geometry(ktlx, default_spec(ktlx.latitude_deg, ktlx.longitude_deg));
    GridderOptions options;
    options.moment = level2::Moment::hca;
    options.method.interpolation = Interpolation::beam_weighted;
    options.method.cell = CellExtent::area;
    const auto grid = make_grid(volume, ktlx, *geometry, options);
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_EQ(grid->provenance.method, "column-nearest");
    std::set<float> values;
    for (std::size_t i = 0; i < grid->values.size(); ++i)
        if (grid->status[i] == CellStatus::value) values.insert(grid->values[i]);
    EXPECT_EQ(values, (std::set<float>{40, 60}));
}

TEST(Gridder, KnowsTheBeamOfEachKindOfRadar) {
    EXPECT_EQ(beam_width_of("KTLX"), 0.95);
    EXPECT_EQ(beam_width_of("TSTL"), 0.55);
    EXPECT_EQ(beam_width_of("????"), 0.95);
}

bool same_bits(const Grid& a, const Grid& b) {
    return a.status == b.status &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

TEST(Gridder, SameBitsForAnyNumberOfThreads) {
    SweepPlan busy = plan(0.5, 1);
    busy.code = [](int radial, int gate) {
        return static_cast<std::uint16_t>((radial * 31 + gate * 17) % 200);
    };
    SweepPlan above = busy;
    above.elevation_deg = 1.5;
    above.cut = 2;
    const level2::Volume volume = make_volume({busy, above});
    const Grid one = make(volume, 1);
    for (const int threads : {2, 3, 8, 500})
        EXPECT_TRUE(same_bits(one, make(volume, threads))) << threads;
}

TEST(Gridder, SameBitsForAnyNumberOfThreadsOnARealVolume) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("volumes/KTLX19990503_235621.gz");
    const Grid one = make(volume, 1);
    for (const int threads : {2, 5})
        EXPECT_TRUE(same_bits(one, make(volume, threads))) << threads;
}

// Uses the Oklahoma outbreak. The supercell that reached Moore half an hour later is some 40 km
// west-southwest of the radar, with a core above 50 dBZ up to at least 8 km.
TEST(Gridder, StormsStandWhereTheyStood) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("volumes/KTLX19990503_235621.gz");
    const Grid grid = make(volume, 1);
    float core = -99;
    for (const double x_km : {-45.0, -40.0, -35.0, -30.0}) {
        for (const double y_km : {-20.0, -15.0, -10.0, -5.0, 0.0}) {
            if (status_at(grid, x_km, y_km, 8) != CellStatus::value) continue;
            core = std::max(core, value_at(grid, x_km, y_km, 8));
        }
    }
    EXPECT_GT(core, 50);
}

}  // namespace
}  // namespace stormcellar::grid

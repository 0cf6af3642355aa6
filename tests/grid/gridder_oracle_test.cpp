// The gridder against its oracle (tests/grid/slow_gridder.h), on real and on made volumes.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "grid/beam_geometry.h"
#include "grid/column_geometry.h"
#include "grid/gridder.h"
#include "grid/site_frame.h"
#include "level2/decode.h"
#include "tests/grid/slow_gridder.h"
#include "tests/grid/volume_maker.h"
#include "tests/testing/data.h"

namespace stormcellar::grid {
namespace {

constexpr double beam_width_deg = 0.95;
constexpr double height_accuracy_m = 0.25;

struct Tally {
    int columns = 0, doubtful_columns = 0;
    int cells = 0, doubtful_cells = 0;
    std::array<int, 4> states{};
};

// A cell may be what the oracle says anywhere within the stated accuracy of height.
void compare_column(const Grid& grid, const SlowColumn& slow, int ix, int iy, Tally& tally) {
    for (int iz = 0; iz < grid.spec.nz(); ++iz) {
        const std::size_t at = grid.spec.index(ix, iy, iz);
        const double level_m = grid.spec.levels_m[static_cast<std::size_t>(iz)];
        const SlowCell low = slow.cell(level_m - height_accuracy_m);
        const SlowCell here = slow.cell(level_m);
        const SlowCell high = slow.cell(level_m + height_accuracy_m);
        ++tally.cells;
        ++tally.states[static_cast<std::size_t>(here.status)];
        if (low.status != here.status || high.status != here.status) {
            ++tally.doubtful_cells;
            continue;
        }
        ASSERT_EQ(grid.status[at], here.status) << ix << " " << iy << " " << level_m;
        if (here.status != CellStatus::value) continue;
        const double tolerance =
            std::abs(low.value - here.value) + std::abs(high.value - here.value) + 1e-3;
        ASSERT_NEAR(grid.values[at], here.value, tolerance) << ix << " " << iy << " " << level_m;
    }
}

Tally compare(const level2::Volume& volume, const SitePosition& site, const GridSpec& spec,
              level2::Moment moment, int step) {
    Tally tally;
    const auto geometry = make_column_geometry(site, spec);
    EXPECT_TRUE(geometry);
    const auto grid = make_grid(volume, site, **geometry, {moment, beam_width_deg, 1});
    EXPECT_TRUE(grid);
    const auto chosen = choose_sweeps(volume, moment, beam_width_deg / 2);
    for (int iy = 0; iy < spec.ny; iy += step) {
        for (int ix = iy % 3; ix < spec.nx; ix += step) {
            const SlowColumn slow(volume, chosen, moment, site, spec, ix, iy, beam_width_deg);
            ++tally.columns;
            if (slow.is_doubtful()) {
                ++tally.doubtful_columns;
                continue;
            }
            compare_column(*grid, slow, ix, iy, tally);
            if (::testing::Test::HasFatalFailure()) return tally;
        }
    }
    EXPECT_LT(tally.doubtful_columns, tally.columns / 10) << "too few columns were compared";
    EXPECT_LT(tally.doubtful_cells, tally.cells / 100 + 1);
    return tally;
}

SitePosition site_of(const level2::Volume& volume) {
    const auto antenna = level2::antenna_position(volume);
    return {volume.station, antenna->latitude_deg, antenna->longitude_deg, antenna->altitude_m};
}

class RealVolume : public ::testing::TestWithParam<const char*> {};

TEST_P(RealVolume, AgreesWithTheOracle) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = level2::decode_file(*testing::data_directory() / "volumes" / GetParam());
    ASSERT_TRUE(decoded);
    const SitePosition site = site_of(decoded->volume);
    const GridSpec spec = default_spec(site.latitude_deg, site.longitude_deg);
    const Tally tally = compare(decoded->volume, site, spec, level2::Moment::ref, 11);
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::value)], 50);
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::no_echo)], 1000);
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::not_seen)], 1000);
}

TEST_P(RealVolume, AgreesWithTheOracleFarFromTheSite) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = level2::decode_file(*testing::data_directory() / "volumes" / GetParam());
    ASSERT_TRUE(decoded);
    const SitePosition site = site_of(decoded->volume);
    GridSpec spec = default_spec(site.latitude_deg + 1.2, site.longitude_deg - 1.7);
    spec.spacing_m = 5000;
    spec.nx = spec.ny = 100;
    compare(decoded->volume, site, spec, level2::Moment::ref, 7);
}

// A grid of one cell that stands at the centre of a gate must hold that gate.
TEST_P(RealVolume, ACellAtAGatesCentreHoldsTheGate) {
    STORMCELLAR_NEED_DATA();
    const auto decoded = level2::decode_file(*testing::data_directory() / "volumes" / GetParam());
    ASSERT_TRUE(decoded);
    const level2::Volume& volume = decoded->volume;
    const SitePosition site = site_of(volume);
    const SiteFrame frame(site.latitude_deg, site.longitude_deg);
    const BeamGeometry beam(site.latitude_deg, site.altitude_m);
    const auto chosen = choose_sweeps(volume, level2::Moment::ref, beam_width_deg / 2);
    std::mt19937 random(17);
    int values = 0;
    for (int i = 0; i < 600; ++i) {
        const ChosenSweep& sweep = chosen[random() % chosen.size()];
        const level2::SweepMoment& moment =
            *volume.sweeps[sweep.sweep_index].find(level2::Moment::ref);
        const std::uint32_t radial = sweep.radials[random() % sweep.radials.size()];
        const auto gate = static_cast<std::int32_t>(3 + random() % 120);
        const level2::GateStatus status = moment.status(radial, gate);
        const EarthPoint point = beam.forward({moment.range_m(gate), sweep.elevation_deg});
        if (status == level2::GateStatus::no_data || point.height_m > 50e3) continue;
        const double azimuth_deg = volume.sweeps[sweep.sweep_index].radials[radial].azimuth_deg;
        const GeoPoint place = frame.to_geo({azimuth_deg, point.arc_m});
        GridSpec spec = default_spec(place.latitude_deg, place.longitude_deg);
        spec.nx = spec.ny = 1;
        spec.levels_m = {point.height_m};
        const auto geometry = make_column_geometry(site, spec);
        const auto grid = make_grid(volume, site, **geometry, {level2::Moment::ref, 0, 1});
        ASSERT_TRUE(grid);
        const bool valid = status == level2::GateStatus::valid;
        ASSERT_EQ(grid->status[0], valid ? CellStatus::value
                                   : status == level2::GateStatus::range_folded
                                       ? CellStatus::range_folded
                                       : CellStatus::no_echo)
            << "cut " << sweep.sweep_index << " radial " << radial << " gate " << gate;
        if (!valid) continue;
        ++values;
        EXPECT_NEAR(grid->values[0], moment.value_of(moment.code(radial, gate)), 0.05);
    }
    EXPECT_GT(values, 20);
}

INSTANTIATE_TEST_SUITE_P(Volumes, RealVolume,
                         ::testing::Values("KTLX19990503_235621.gz", "KLIX20050828_180149.gz",
                                           "KLOT20220317_000842_V06", "KOKX20080109_141449.gz",
                                           "KATX20160427_095248_V06.gz"));

// States scattered at random, so that every pair of them meets at every weight.
level2::Volume scattered_volume(level2::Moment moment) {
    std::mt19937 random(23);
    std::vector<SweepPlan> plans;
    for (const double elevation_deg : {-0.2, 0.5, 1.4, 2.4, 4.3, 9.9, 19.5}) {
        SweepPlan plan;
        plan.elevation_deg = elevation_deg;
        plan.cut = static_cast<int>(plans.size()) + 1;
        plan.moment = moment;
        plan.gates = 120;
        plan.gate_spacing_m = 2000;
        plan.radials = 300;  // a gap of 60 degrees
        plan.first_azimuth_deg = 200.5;
        plan.code = [&random](int, int) {
            const auto drawn = random() % 6;
            return static_cast<std::uint16_t>(drawn < 2 ? drawn : 2 + random() % 200);
        };
        plans.push_back(plan);
    }
    return make_volume(plans);
}

TEST(GridderOracle, ScatteredStates) {
    const SitePosition site{"XXXX", 44, 11, 300};
    GridSpec spec = default_spec(44, 11);
    spec.spacing_m = 4100;
    spec.nx = spec.ny = 130;
    for (const level2::Moment moment : {level2::Moment::ref, level2::Moment::rho}) {
        const Tally tally = compare(scattered_volume(moment), site, spec, moment, 3);
        for (const int count : tally.states)
            EXPECT_GT(count, 500);
    }
}

TEST(GridderOracle, ALostCut) {
    level2::Volume volume = scattered_volume(level2::Moment::ref);
    volume.vcp = 21;  // which has 3.35 degrees too
    const SitePosition site{"XXXX", -33, 151, 10};
    GridSpec spec = default_spec(-33, 151);
    spec.spacing_m = 4100;
    spec.nx = spec.ny = 100;
    compare(volume, site, spec, level2::Moment::ref, 3);
}

}  // namespace
}  // namespace stormcellar::grid

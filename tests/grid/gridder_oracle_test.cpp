// Tests the gridder against its oracle (grid/judge/oracle.h), with every method, on real and
// synthetic volumes.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "grid/judge/oracle.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/site_frame.h"
#include "tests/grid/method_of.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"
#include "tests/testing/slow_down.h"

namespace stormcellar::grid {
namespace {

constexpr double beam_width_deg = 0.95;
// Tables by arc are accurate to 0.15 m in range and height. The elevation of a single radial adds
// 0.25 m, or 1 m at the edges of the beam.
constexpr double height_accuracy_m = 1;
constexpr double weight_accuracy = 2e-3;

struct Tally {
    int columns = 0, doubtful_columns = 0;
    int cells = 0, doubtful_cells = 0;
    std::array<int, cell_status_count> states{};
    std::vector<double> differences;
};

// Compares a column. The status and the value of a cell must equal the oracle's at some height
// within the stated accuracy. `slack` is an additional tolerance, because a gate on the edge of a
// cell's outline may count or not.
void compare_column(const Grid& grid, const OracleColumn& slow, int ix, int iy, double slack,
                    Tally& tally) {
    for (std::size_t level = 0; level < grid.spec.levels_m.size(); ++level) {
        const std::size_t at = grid.spec.index(ix, iy, static_cast<int>(level));
        const OracleCell low = slow.cell(level, -height_accuracy_m);
        const OracleCell here = slow.cell(level);
        const OracleCell high = slow.cell(level, height_accuracy_m);
        ++tally.cells;
        ++tally.states[static_cast<std::size_t>(here.status)];
        const bool doubtful = low.status != here.status || high.status != here.status ||
                              here.margin < weight_accuracy || here.wide_on_circle;
        if (doubtful) {
            ++tally.doubtful_cells;
            continue;
        }
        ASSERT_EQ(grid.status[at], here.status) << ix << " " << iy << " " << level;
        if (here.status != CellStatus::value) continue;
        const double tolerance =
            std::abs(low.value - here.value) + std::abs(high.value - here.value) + slack;
        tally.differences.push_back(std::abs(static_cast<double>(grid.values[at]) - here.value));
        ASSERT_NEAR(grid.values[at], here.value, tolerance) << ix << " " << iy << " " << level;
    }
}

struct Comparison {
    level2::Moment moment = level2::Moment::ref;
    Method method;
    int step = 11;
    double most_doubtful_columns = 0.1;
    double most_doubtful_cells = 0.01;
    double slack = 0.05;
};

Tally compare(const level2::Volume& volume, const SitePosition& site, const GridSpec& spec,
              const Comparison& how) {
    Tally tally;
    const auto geometry = make_column_geometry(site, spec);
    EXPECT_TRUE(geometry);
    const auto grid =
        make_grid(volume, site, **geometry, {how.moment, beam_width_deg, 1, how.method, {}});
    EXPECT_TRUE(grid);
    const auto chosen = choose_sweeps(volume, how.moment, beam_width_deg / 2);
    const OracleSetting setting{how.moment, beam_width_deg, false, how.method, {}};
    for (int iy = 0; iy < spec.ny; iy += how.step) {
        for (int ix = iy % 3; ix < spec.nx; ix += how.step) {
            const OracleColumn slow(volume, chosen, setting, site, spec, ix, iy);
            ++tally.columns;
            if (slow.is_doubtful()) {
                ++tally.doubtful_columns;
                continue;
            }
            compare_column(*grid, slow, ix, iy, how.slack, tally);
            if (::testing::Test::HasFatalFailure()) return tally;
        }
    }
    EXPECT_LT(tally.doubtful_columns, tally.columns * how.most_doubtful_columns)
        << "too few columns were compared";
    EXPECT_LT(tally.doubtful_cells, tally.cells * how.most_doubtful_cells + 1);
    return tally;
}

class RealVolume : public ::testing::TestWithParam<const char*> {};

TEST_P(RealVolume, AgreesWithTheOracle) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume(std::string("volumes/") + GetParam());
    const SitePosition site = site_of(volume);
    const GridSpec spec = default_spec(site.latitude_deg, site.longitude_deg);
    const Tally tally = compare(volume, site, spec, {});
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::value)], 50);
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::no_echo)], 1000);
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::not_seen)], 1000);
}

TEST_P(RealVolume, AgreesWithTheOracleFarFromTheSite) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume(std::string("volumes/") + GetParam());
    const SitePosition site = site_of(volume);
    GridSpec spec = square_spec(site.latitude_deg + 1.2, site.longitude_deg - 1.7, 100, 5000);
    compare(volume, site, spec, {level2::Moment::ref, {}, 7});
}

// A grid of one cell at the center of a gate must hold that gate.
TEST_P(RealVolume, ACellAtAGatesCentreHoldsTheGate) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume(std::string("volumes/") + GetParam());
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
        const level2::Radial& header = volume.sweeps[sweep.sweep_index].radials[radial];
        const EarthPoint point = beam.forward({moment.range_m(gate), header.elevation_deg});
        if (status == level2::GateStatus::no_data || point.height_m > 50e3) continue;
        const double azimuth_deg = header.azimuth_deg;
        const GeoPoint place = frame.to_geo({azimuth_deg, point.arc_m});
        GridSpec spec = square_spec(place.latitude_deg, place.longitude_deg, 1);
        spec.levels_m = {point.height_m};
        const auto geometry = make_column_geometry(site, spec);
        const auto grid = make_grid(volume, site, **geometry, {});
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

// Tests every other method on one volume with echo, holes and folded gates.
class EveryMethod : public ::testing::TestWithParam<Method> {};

TEST_P(EveryMethod, AgreesWithTheOracle) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("volumes/KTLX19990503_235621.gz");
    const SitePosition site = site_of(volume);
    GridSpec spec = square_spec(site.latitude_deg + 0.3, site.longitude_deg - 0.4,
                                GetParam().cell == CellExtent::area ? 80 : 200,
                                GetParam().cell == CellExtent::area ? 4000 : 1700);
    const bool area = GetParam().cell == CellExtent::area;
    Comparison how{level2::Moment::ref, GetParam(),
                   (area ? 17 : 9) * (testing::slow_down > 1 ? 2 : 1)};
    how.most_doubtful_cells = area ? 0.06 : 0.02;
    if (area) how.slack = 0.8;
    const Tally tally = compare(volume, site, spec, how);
    EXPECT_GT(tally.states[static_cast<std::size_t>(CellStatus::value)], 50 / testing::slow_down);
    std::vector<double> differences = tally.differences;
    std::sort(differences.begin(), differences.end());
    EXPECT_LT(differences[differences.size() * 9 / 10], 0.05);
    if (GetParam().averaging == Averaging::in_z) return;
    how.moment = level2::Moment::vel;
    how.most_doubtful_cells = area ? 0.15 : 0.1;
    compare(volume, site, spec, how);
}

INSTANTIATE_TEST_SUITE_P(
    Methods, EveryMethod,
    ::testing::Values(method_of(Interpolation::nearest), method_of(Interpolation::linear),
                      method_of(Interpolation::linear, CellExtent::point, Averaging::in_z),
                      method_of(Interpolation::eight_point),
                      method_of(Interpolation::eight_point, CellExtent::point, Averaging::in_z),
                      method_of(Interpolation::beam_weighted),
                      method_of(Interpolation::linear, CellExtent::area),
                      method_of(Interpolation::beam_weighted, CellExtent::area),
                      method_of(Interpolation::beam_weighted, CellExtent::area, Averaging::in_z)));

// Returns a volume of random states, so that every pair of states occurs with every weight.
level2::Volume scattered_volume(level2::Moment moment) {
    std::mt19937 random(23);
    SweepPlan plan;
    plan.moment = moment;
    plan.gates = 120;
    plan.gate_spacing_m = 2000;
    plan.radials = 300;  // a gap of 60 degrees
    plan.first_azimuth_deg = 200.5;
    const unsigned first_value = level2::facts_of(moment).first_valid_code;
    plan.code = [&random, first_value](int, int) {
        const auto drawn = random() % 6;
        return static_cast<std::uint16_t>(drawn < first_value ? drawn
                                                              : first_value + random() % 200);
    };
    return make_volume(plans_at({-0.2, 0.5, 1.4, 2.4, 4.3, 9.9, 19.5}, plan));
}

TEST(GridderOracle, ScatteredStates) {
    const SitePosition site{"XXXX", 44, 11, 300};
    GridSpec spec = square_spec(44, 11, 130, 4100);
    for (const level2::Moment moment :
         {level2::Moment::ref, level2::Moment::rho, level2::Moment::veld}) {
        const Tally tally = compare(scattered_volume(moment), site, spec, {moment, {}, 3});
        for (const CellStatus state : states_of(moment))
            EXPECT_GT(tally.states[static_cast<std::size_t>(state)], 500);
    }
}

TEST(GridderOracle, ALostCut) {
    level2::Volume volume = scattered_volume(level2::Moment::ref);
    volume.vcp = 21;  // pattern 21 also has 3.35 degrees
    const SitePosition site{"XXXX", -33, 151, 10};
    GridSpec spec = square_spec(-33, 151, 100, 4100);
    compare(volume, site, spec, {level2::Moment::ref, {}, 3});
}

TEST(GridderOracle, EveryProjectionOffItsSiteAndAcrossTheAntimeridian) {
    const SitePosition site{"XXXX", 52, 179.9, 300};
    GridSpec spec = square_spec(52.5, -179.7, 110);
    spec.projection = Projection::latitude_longitude;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.041;
    const level2::Volume volume = scattered_volume(level2::Moment::ref);
    const Tally degrees = compare(volume, site, spec, {level2::Moment::ref, {}, 3});
    Comparison area{level2::Moment::ref, {}, 17};
    area.method = method_of(Interpolation::beam_weighted, CellExtent::area);
    area.most_doubtful_cells = 0.2;
    area.slack = 20;  // neighboring gates are independent here
    const Tally area_degrees = compare(volume, site, spec, area);
    spec.projection = Projection::lambert_conformal;
    spec.spacing_m = 4100;
    spec.spacing_deg = 0;
    spec.parallels_deg = {50, 55};
    const Tally cone = compare(volume, site, spec, {level2::Moment::ref, {}, 3});
    const Tally area_cone = compare(volume, site, spec, area);
    for (const Tally& tally : {degrees, cone}) {
        for (const CellStatus state : states_of(level2::Moment::ref))
            EXPECT_GT(tally.states[static_cast<std::size_t>(state)], 200);
    }
    for (Tally tally : {area_degrees, area_cone}) {
        std::sort(tally.differences.begin(), tally.differences.end());
        EXPECT_LT(tally.differences[tally.differences.size() * 9 / 10], 0.1);
    }
}

}  // namespace
}  // namespace stormcellar::grid

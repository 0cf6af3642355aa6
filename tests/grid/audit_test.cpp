#include "grid/judge/audit.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

constexpr double degree = 0.017453292519943295;
const SitePosition site{"KTLX", 35.3333, -97.2778, 389};

// Returns a field that is linear in space, so that cells represent it exactly: it rises by 0.4 dB
// per kilometer to the northeast and falls by 1.5 dB per kilometer of height.
double field_dbz(double x_m, double y_m, double z_m) {
    return 40 + 0.1e-3 * x_m + 0.12e-3 * y_m - 1.5e-3 * z_m;
}

GridSpec small_spec() {
    GridSpec spec = square_spec(site.latitude_deg, site.longitude_deg, 160);
    spec.levels_m.resize(20);
    return spec;
}

// Observes the field in each gate, rounded to the radar's codes of half a decibel.
level2::Volume observed(double turned_deg = 0) {
    const BeamGeometry beam(site.latitude_deg, site.altitude_m);
    std::vector<SweepPlan> plans;
    int cut = 0;
    for (const double elevation_deg : {0.5, 1.5, 2.5, 3.5, 5.0, 7.0, 10.0}) {
        SweepPlan plan;
        plan.elevation_deg = elevation_deg;
        plan.cut = ++cut;
        plan.gates = 200;
        plan.code = [beam, elevation_deg, turned_deg](int radial, int gate) {
            const auto place = beam.forward({gate * 1000.0, elevation_deg});
            const double azimuth = (radial + 0.5 - turned_deg) * degree;
            const double dbz = field_dbz(place.arc_m * std::sin(azimuth),
                                         place.arc_m * std::cos(azimuth), place.height_m);
            return ref_code(std::round(2 * dbz) / 2);
        };
        plans.push_back(plan);
    }
    return make_volume(plans);
}

// Returns the field at the cells, with a value everywhere.
BrickGrid grid_of_field(const GridSpec& spec, double shift_m = 0) {
    Grid grid;
    grid.spec = spec;
    grid.values.resize(spec.cell_count());
    grid.status.assign(spec.cell_count(), CellStatus::value);
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            for (int iz = 0; iz < spec.nz(); ++iz) {
                grid.values[spec.index(ix, iy, iz)] =
                    static_cast<float>(field_dbz(spec.x_m(ix) - shift_m, spec.y_m(iy),
                                                 spec.levels_m[static_cast<std::size_t>(iz)]));
            }
        }
    }
    return BrickGrid::from(grid, default_quantization(level2::Moment::ref));
}

GridderOptions of(level2::Moment moment) {
    GridderOptions options;
    options.moment = moment;
    return options;
}

AuditRow total(const Result<Audit>& audit) {
    EXPECT_TRUE(audit);
    return audit ? pooled(audit->rows) : AuditRow{};
}

// Gates and cells are both rounded to steps of 0.5 dB. The rounding of a gate adds an RMS of 0.144
// dB, and the rounding of the eight cells around the gate adds less.
TEST(Audit, AFieldThatCellsHoldAuditsToTheQuantisation) {
    const BrickGrid grid = grid_of_field(small_spec());
    const auto audited = audit(grid.view(), observed(), site, {});
    const AuditRow row = total(audited);
    EXPECT_GT(row.count, 3000U);
    EXPECT_EQ(row.count, row.sampled);
    EXPECT_LT(row.rms, 0.205) << "rounding of both: sqrt(2) * 0.5 / sqrt(12)";
    EXPECT_GT(row.rms, 0.144) << "the rounding of the gates alone";
    EXPECT_NEAR(row.mean, 0, 0.01);
}

TEST(Audit, AGridShiftedByACellShowsIt) {
    const BrickGrid grid = grid_of_field(small_spec(), 1000);
    const AuditRow row = total(audit(grid.view(), observed(), site, {}));
    EXPECT_NEAR(row.mean, -0.1, 0.01) << "0.1 dB per kilometer to the east";
}

// At 100 km, half a degree is 0.87 km. A turned volume errs most where the field changes with
// azimuth.
TEST(Audit, AVolumeTurnedByHalfADegreeShowsItAndMoreWithRange) {
    const BrickGrid grid = grid_of_field(small_spec());
    const level2::Volume straight = observed();
    const level2::Volume turned = observed(5);
    const AuditRow before = total(audit(grid.view(), straight, site, {}));
    const auto found = audit(grid.view(), turned, site, {});
    const AuditRow after = total(found);
    EXPECT_GT(after.rms, 1.5F * before.rms);
    const auto ranges = pooled_by_range(found->rows);
    ASSERT_GE(ranges.size(), 2U);
    EXPECT_GT(ranges[1].rms, 1.2F * ranges[0].rms);
}

TEST(Audit, StatesThatDisagreeAreCountedApart) {
    const GridSpec spec = small_spec();
    Grid empty;
    empty.spec = spec;
    empty.values.resize(spec.cell_count());
    empty.status.assign(spec.cell_count(), CellStatus::no_echo);
    const BrickGrid grid = BrickGrid::from(empty, {});
    const auto found = audit(grid.view(), observed(), site, {});
    const AuditRow row = total(found);
    EXPECT_GT(row.sampled, 3000U);
    EXPECT_EQ(row.same_status, 0U);
    EXPECT_EQ(row.count, 0U);
    const auto value = static_cast<std::size_t>(CellStatus::value);
    EXPECT_EQ(found->states[value][static_cast<std::size_t>(CellStatus::no_echo)], row.sampled);
}

// With a Nyquist velocity of 25 m/s, velocities of 24 and -24 m/s differ by 2 m/s.
TEST(Audit, VelocitiesDifferByTheShorterWayRound) {
    SweepPlan plan;
    plan.moment = level2::Moment::vel;
    plan.code = [](int, int) { return ref_code(24); };
    SweepPlan high = plan;
    high.elevation_deg = 1.5;
    high.cut = 2;
    level2::Volume volume = make_volume({plan, high});
    change_radials(volume, [&](level2::Radial& radial) { radial.nyquist_mps = 25; });
    Grid all;
    all.spec = small_spec();
    all.moment = level2::Moment::vel;
    all.values.assign(all.spec.cell_count(), -24);
    all.status.assign(all.spec.cell_count(), CellStatus::value);
    const BrickGrid grid = BrickGrid::from(all, default_quantization(level2::Moment::vel));
    const AuditRow row = total(audit(grid.view(), volume, site, of(level2::Moment::vel)));
    EXPECT_NEAR(row.mean, 2, 1e-4);
    EXPECT_NEAR(row.rms, 2, 1e-4);
}

// A quarter of the gates is ambiguous. Their cells are ambiguous, too, and the mean velocity around
// them stays 24 m/s.
TEST(Audit, AmbiguousGatesAreCountedAndEnterNoValue) {
    SweepPlan plan;
    plan.moment = level2::Moment::veld;
    plan.code = [](int radial, int) {
        return radial < 90 ? std::uint16_t{2} : ref_code(24);  // code 2 is ambiguous
    };
    const level2::Volume volume = make_volume(plans_at({0.5, 1.5, 2.5, 3.5}, plan));
    const auto geometry = make_column_geometry(site, small_spec());
    const GridderOptions options = of(level2::Moment::veld);
    const auto made = make_grid(volume, site, **geometry, options);
    ASSERT_TRUE(made);
    const BrickGrid grid = BrickGrid::from(*made, default_quantization(level2::Moment::veld));
    const auto found = audit(grid.view(), volume, site, options);
    ASSERT_TRUE(found);
    const auto at = [&](CellStatus gate, CellStatus cell) {
        return found->states[static_cast<std::size_t>(gate)][static_cast<std::size_t>(cell)];
    };
    const auto ambiguous = at(CellStatus::ambiguous, CellStatus::ambiguous);
    EXPECT_GT(ambiguous, 500U);
    EXPECT_LT(at(CellStatus::ambiguous, CellStatus::value), ambiguous / 20)
        << "only cells at the borders disagree";
    EXPECT_GT(at(CellStatus::value, CellStatus::value), 2 * ambiguous);
    const AuditRow row = total(found);
    EXPECT_GT(row.same_status, ambiguous);
    EXPECT_EQ(row.mean, 0);
    EXPECT_EQ(row.rms, 0);
}

TEST(Audit, WhatItCannotDoIsAnError) {
    const BrickGrid grid = grid_of_field(small_spec());
    const level2::Volume volume = observed();
    AuditOptions options{.range_step_m = 0};
    EXPECT_EQ(audit(grid.view(), volume, site, {}, options).error().code, ErrorCode::bad_argument);
    options = {};
    options.azimuth_step_deg = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(audit(grid.view(), volume, site, {}, options).error().code, ErrorCode::bad_argument);
    options = {};
    options.threads = 0;
    EXPECT_EQ(audit(grid.view(), volume, site, {}, options).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(audit(grid.view(), volume, site, of(level2::Moment::zdr)).error().code,
              ErrorCode::not_found);
}

// Audits real volumes gridded with the defaults. The method `nearest` has larger errors near the
// radar, where most gates are and echo changes most between gates and cells. Far away it has
// smaller errors, because it repeats the gates.
struct Real {
    level2::Volume volume;
    SitePosition site;
};

Real real(const char* file) {
    Real made{real_volume(file), {}};
    made.site = site_of(made.volume);
    return made;
}

BrickGrid gridded(const Real& of, const GridSpec& spec, const GridderOptions& options) {
    const auto geometry = make_column_geometry(of.site, spec);
    EXPECT_TRUE(geometry);
    const auto grid = make_grid(of.volume, of.site, **geometry, options);
    EXPECT_TRUE(grid);
    return BrickGrid::from(*grid, default_quantization(options.moment));
}

struct Expected {
    const char* file;
    std::vector<double> rms_db;  // upper bounds by range class
    double least_same;           // least share of gates whose status equals the grid's
};

class AuditOfRealVolumes : public ::testing::TestWithParam<Expected> {};

TEST_P(AuditOfRealVolumes, HasItsStatedErrorsAndMoreByNearest) {
    STORMCELLAR_NEED_DATA();
    const Real of = real(GetParam().file);
    const GridSpec spec = default_spec(of.site.latitude_deg, of.site.longitude_deg);
    const BrickGrid linear = gridded(of, spec, {});
    const auto found = audit(linear.view(), of.volume, of.site, {});
    ASSERT_TRUE(found);
    const auto ranges = pooled_by_range(found->rows);
    ASSERT_GE(ranges.size(), GetParam().rms_db.size());
    for (std::size_t i = 0; i < GetParam().rms_db.size(); ++i) {
        SCOPED_TRACE(range_text(ranges[i]) + ": " + errors_text(ranges[i], "dB"));
        EXPECT_GT(ranges[i].count, 500U);
        EXPECT_LT(ranges[i].rms, GetParam().rms_db[i]);
        EXPECT_GT(ranges[i].rms, 0.7 * GetParam().rms_db[i]) << "the stated error is too large";
    }
    for (const AuditRow& row : found->rows)
        EXPECT_TRUE(is_possible(row)) << errors_text(row, "dB");
    const AuditRow all = pooled(found->rows);
    EXPECT_GT(all.same_status, GetParam().least_same * all.sampled) << errors_text(all, "dB");

    GridderOptions options;
    options.method.interpolation = Interpolation::nearest;
    const BrickGrid nearest = gridded(of, spec, options);
    EXPECT_GT(total(audit(nearest.view(), of.volume, of.site, options)).rms, all.rms);
}
INSTANTIATE_TEST_SUITE_P(
    Files, AuditOfRealVolumes,
    ::testing::Values(Expected{"volumes/KTLX19990503_235621.gz", {4, 1.1, 0.9}, 0.98},
                      Expected{"volumes/KLOT20220317_000842_V06", {4.8}, 0.96}));

// Turns the antenna by half a degree over real echo. The grid no longer fits its gates. Only gates
// near the radar still fit, because they hardly move.
TEST(Audit, ARealVolumeTurnedByHalfADegreeShowsIt) {
    STORMCELLAR_NEED_DATA();
    Real of = real("volumes/KTLX19990503_235621.gz");
    const GridSpec spec = default_spec(of.site.latitude_deg, of.site.longitude_deg);
    const BrickGrid grid = gridded(of, spec, {});
    const auto straight = audit(grid.view(), of.volume, of.site, {});
    turn_clockwise(of.volume, 0.5F);
    const auto turned = audit(grid.view(), of.volume, of.site, {});
    ASSERT_TRUE(straight && turned);
    for (const std::size_t range : {1U, 2U}) {
        const AuditRow before = pooled_by_range(straight->rows).at(range);
        const AuditRow after = pooled_by_range(turned->rows).at(range);
        EXPECT_GT(after.rms, 1.3F * before.rms) << errors_text(after, "dB");
    }
}

TEST(Audit, IsTheSameForAnyNumberOfThreadsAndOffCentre) {
    STORMCELLAR_NEED_DATA();
    const Real of = real("volumes/KLOT20220317_000842_V06");
    GridSpec spec = default_spec(of.site.latitude_deg, of.site.longitude_deg);
    const AuditRow centred = total(audit(gridded(of, spec, {}).view(), of.volume, of.site, {}));
    spec.center_longitude_deg += 0.5;
    spec.projection = Projection::lambert_conformal;
    spec.parallels_deg = {spec.center_latitude_deg, spec.center_latitude_deg};
    const BrickGrid grid = gridded(of, spec, {});
    AuditOptions options;
    const auto one = audit(grid.view(), of.volume, of.site, {}, options);
    options.threads = 3;
    const auto three = audit(grid.view(), of.volume, of.site, {}, options);
    ASSERT_TRUE(one && three);
    EXPECT_EQ(one->rows, three->rows);
    EXPECT_EQ(one->states, three->states);
    EXPECT_NEAR(pooled(one->rows).rms, centred.rms, 0.15 * centred.rms)
        << "the frame adds no error";
}

TEST(AuditRows, ArePooledByTheirCounts) {
    const float end = std::numeric_limits<float>::infinity();
    const std::vector<AuditRow> rows = {{0.5F, 0, 60e3F, 10, 10, 10, 1, 1},
                                        {0.5F, 60e3F, end, 30, 20, 0, 0, 0},
                                        {1.5F, 0, 60e3F, 40, 35, 30, 3, -1}};
    const AuditRow all = pooled(rows);
    EXPECT_EQ(all.sampled, 80U);
    EXPECT_EQ(all.same_status, 65U);
    EXPECT_EQ(all.count, 40U);
    EXPECT_NEAR(all.rms, std::sqrt(7.0), 1e-6);
    EXPECT_NEAR(all.mean, -0.5, 1e-6);
    EXPECT_EQ(all.range_to_m, end);
    ASSERT_EQ(pooled_by_range(rows).size(), 2U);
    EXPECT_EQ(pooled_by_range(rows)[0].count, 40U);
    ASSERT_EQ(pooled_by_sweep(rows).size(), 2U);
    EXPECT_EQ(pooled_by_sweep(rows)[0].count, 10U);
    EXPECT_EQ(pooled({}), AuditRow{});
    EXPECT_EQ(range_text(rows[0]), "0 to 60 km");
    EXPECT_EQ(range_text(rows[1]), "beyond 60 km");
    EXPECT_EQ(errors_text(rows[2], "dB"),
              "RMS 3.00 dB, mean -1.00 dB over 30 gates; status the same in 87.5 % of 40");
}

TEST(AuditRows, ThatNoAuditCanGiveAreImpossible) {
    const AuditRow good{0.5F, 0, 60e3F, 40, 35, 30, 3, -1};
    EXPECT_TRUE(is_possible(good));
    const auto with = [&](auto change) {
        AuditRow row = good;
        change(row);
        return is_possible(row);
    };
    EXPECT_TRUE(
        with([](AuditRow& row) { row.range_to_m = std::numeric_limits<float>::infinity(); }));
    EXPECT_FALSE(with([](AuditRow& row) { row.count = 36; }));
    EXPECT_FALSE(with([](AuditRow& row) { row.same_status = 41; }));
    EXPECT_FALSE(with([](AuditRow& row) { row.rms = -1; }));
    EXPECT_FALSE(with([](AuditRow& row) { row.mean = 4; }));
    EXPECT_FALSE(with([](AuditRow& row) { row.rms = NAN; }));
    EXPECT_FALSE(with([](AuditRow& row) { row.elevation_deg = NAN; }));
    EXPECT_FALSE(with([](AuditRow& row) { row.range_to_m = 0; }));
}

}  // namespace
}  // namespace stormcellar::grid

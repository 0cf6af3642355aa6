// Tests grids for an instant against echoes whose truth is known at any time.
#include "grid/mosaic/time_interpolation.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "stormcellar/grid/gridder.h"
#include "tests/grid/moving_blobs.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::grid {
namespace {

constexpr UtcTime start{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1}};
constexpr double apart_s = 300;

UtcTime at_second(double seconds) {
    return start + std::chrono::milliseconds{std::llround(seconds * 1000)};
}

GridSpec spec_of(int cells = 120) {
    GridSpec spec = square_spec(35, -97, cells);
    spec.levels_m = {1000, 2000, 4000};
    return spec;
}

// Two grids of a scene, 300 s apart, and the geometry of their columns.
struct Pair {
    explicit Pair(std::vector<Blob> its_blobs, const GridSpec& its_spec = spec_of(),
                  double seen_km = 1e9)
        : blobs(std::move(its_blobs)),
          spec(its_spec),
          before(BrickGrid::from(blob_grid(spec, blobs, 0, seen_km), quantization())),
          after(BrickGrid::from(blob_grid(spec, blobs, apart_s, seen_km), quantization())),
          geometry(*make_column_geometry({"KTLX", 35, -97, 300}, spec)) {}

    static Quantization quantization() { return default_quantization(level2::Moment::ref); }
    [[nodiscard]] TimedView early() const { return {before.view(), start}; }
    [[nodiscard]] TimedView late() const { return {after.view(), at_second(apart_s)}; }
    [[nodiscard]] Grid at(const InstantOptions& options) const {
        auto made = grid_at(early(), late(), *geometry, options);
        EXPECT_TRUE(made) << made.error().message;
        return to_dense(made->view());
    }

    std::vector<Blob> blobs;
    GridSpec spec;
    BrickGrid before, after;
    std::shared_ptr<const ColumnGeometry> geometry;
};

InstantOptions options_at(double seconds, TimeMethod method, const MotionField* motion = nullptr) {
    return InstantOptions{.instant = at_second(seconds), .method = method, .motion = motion};
}

// Returns the RMS error where the truth is above 5 dBZ. Cells without a value count as 0 dBZ.
double rms_error(const Pair& pair, const Grid& grid, double t_s) {
    double sum = 0;
    int count = 0;
    for (int iy = 0; iy < pair.spec.ny; ++iy) {
        for (int ix = 0; ix < pair.spec.nx; ++ix) {
            const double truth =
                blobs_dbz(pair.blobs, pair.spec.x_m(ix) / 1000, pair.spec.y_m(iy) / 1000, t_s);
            if (truth < 5) continue;
            const std::size_t cell = pair.spec.index(ix, iy, 1);
            const bool valued = grid.status[cell] == CellStatus::value;
            const double value = valued ? static_cast<double>(grid.values[cell]) : 0;
            sum += (value - truth) * (value - truth);
            ++count;
        }
    }
    EXPECT_GT(count, 300);
    return std::sqrt(sum / count);
}

const std::vector<Blob> moving = {{-15, -10, 12, 50, 20, 10}, {12, 20, 9, 42, 20, 10}};

TEST(GridAt, AdvectedIsTheTruthOfWhatDrifts) {
    const Pair pair(moving);
    const MotionField motion({0.02F, 0.01F});
    for (const double t_s : {0.0, 60.0, 150.0, 222.0, 300.0}) {
        const Grid grid = pair.at(options_at(t_s, TimeMethod::advected, &motion));
        // The error is above 0 because both volumes are rounded to steps of 0.5 dB and linear
        // interpolation lowers the peaks.
        EXPECT_LT(rms_error(pair, grid, t_s), 0.35) << t_s;
    }
}

TEST(GridAt, AdvectedBeatsBlendBeatsNearest) {
    const Pair pair(moving);
    const MotionField motion({0.02F, 0.01F});
    const double advected =
        rms_error(pair, pair.at(options_at(120, TimeMethod::advected, &motion)), 120);
    const double blend = rms_error(pair, pair.at(options_at(120, TimeMethod::blend)), 120);
    const double nearest = rms_error(pair, pair.at(options_at(120, TimeMethod::nearest)), 120);
    EXPECT_LT(advected, 0.35);
    EXPECT_LT(2 * advected, blend);
    EXPECT_LT(blend, nearest);
}

TEST(GridAt, NearestIsTheNearerVolumeUntouched) {
    const Pair pair(moving);
    const auto values_at = [&](double t_s) {
        return pair.at(options_at(t_s, TimeMethod::nearest)).values;
    };
    const std::vector<float> before = to_dense(pair.before.view()).values;
    EXPECT_EQ(values_at(149), before);
    EXPECT_EQ(values_at(151), to_dense(pair.after.view()).values);
    EXPECT_EQ(values_at(150), before) << "the earlier of two equally near volumes";
}

TEST(GridAt, ClassesAreThoseOfTheNearerVolume) {
    Grid early;
    early.spec = spec_of(20);
    early.moment = level2::Moment::hca;
    early.values.assign(early.spec.cell_count(), 40);  // dry snow
    early.status.assign(early.spec.cell_count(), CellStatus::value);
    Grid late = early;
    late.values.assign(late.values.size(), 90);  // graupel
    const Quantization codes = default_quantization(level2::Moment::hca);
    const BrickGrid before = BrickGrid::from(early, codes), after = BrickGrid::from(late, codes);
    const auto geometry = *make_column_geometry({"KTLX", 35, -97, 300}, early.spec);
    for (const auto& [second, value] : {std::pair{60.0, 40.0F}, std::pair{240.0, 90.0F}}) {
        InstantOptions options = options_at(second, TimeMethod::blend);
        options.moment = level2::Moment::hca;
        const auto made = grid_at({before.view(), start},
                                  TimedView{after.view(), at_second(apart_s)}, *geometry, options);
        ASSERT_TRUE(made);
        for (const float found : to_dense(made->view()).values)
            ASSERT_EQ(found, value);
    }
}

TEST(GridAt, BlendAtEitherEndIsThatVolume) {
    const Pair pair(moving);
    EXPECT_EQ(pair.at(options_at(0, TimeMethod::blend)).status,
              to_dense(pair.before.view()).status);
    EXPECT_EQ(pair.at(options_at(300, TimeMethod::blend)).values,
              to_dense(pair.after.view()).values);
}

TEST(GridAt, ACellThatOneEndHasNotSeenIsTheOtherOnes) {
    const Pair all(moving);
    const Pair part(moving, spec_of(), 40);  // the radar sees 40 km
    InstantOptions options = options_at(100, TimeMethod::blend);
    const auto made = grid_at(all.early(), part.late(), *all.geometry, options);
    ASSERT_TRUE(made);
    const Grid grid = to_dense(made->view());
    const Grid before = to_dense(all.before.view());
    for (std::size_t cell = 0; cell < grid.status.size(); ++cell) {
        ASSERT_NE(grid.status[cell], CellStatus::not_seen);
    }
    const std::size_t corner = all.spec.index(2, 2, 1);
    EXPECT_EQ(grid.status[corner], before.status[corner]);
}

// The velocity of the later volume is 20 m/s everywhere. The earlier volume is ambiguous.
TEST(GridAt, AmbiguousCellsAreMixedByTheRuleAndEnterNoValue) {
    const GridSpec spec = spec_of(40);
    const auto geometry = make_column_geometry({"KTLX", 35, -97, 300}, spec);
    const auto bricks_of = [&](CellStatus status) {
        Grid grid;
        grid.spec = spec;
        grid.values.assign(spec.cell_count(), 20);
        grid.status.assign(spec.cell_count(), status);
        return BrickGrid::from(grid, default_quantization(level2::Moment::veld));
    };
    const BrickGrid before = bricks_of(CellStatus::ambiguous), after = bricks_of(CellStatus::value);
    const MotionField motion({0.02F, 0.01F});
    for (const double t_s : {0.0, 100.0, 200.0, 300.0}) {
        for (const TimeMethod method :
             {TimeMethod::nearest, TimeMethod::blend, TimeMethod::advected}) {
            InstantOptions options = options_at(t_s, method, &motion);
            options.moment = level2::Moment::veld;
            const auto made = grid_at({before.view(), start}, {{after.view(), at_second(apart_s)}},
                                      **geometry, options);
            ASSERT_TRUE(made) << made.error().message;
            const Grid grid = to_dense(made->view());
            const std::size_t middle = spec.index(20, 20, 1);
            ASSERT_EQ(grid.status[middle], t_s < 150 ? CellStatus::ambiguous : CellStatus::value)
                << t_s << " " << time_method_name(method);
            for (std::size_t cell = 0; cell < grid.status.size(); ++cell) {
                if (grid.status[cell] != CellStatus::value) continue;
                ASSERT_EQ(grid.values[cell], 20) << t_s << " " << time_method_name(method);
            }
        }
    }
}

TEST(GridAt, WhatComesFromBeyondTheEdgeIsNotSeen) {
    const Pair pair({}, spec_of(), 50);
    const MotionField motion({0.1F, 0});  // 30 km in 300 s
    InstantOptions options = options_at(300, TimeMethod::advected, &motion);
    const auto made = grid_at(pair.early(), std::nullopt, *pair.geometry, options);
    ASSERT_TRUE(made);
    const Grid grid = to_dense(made->view());
    EXPECT_EQ(grid.status[pair.spec.index(15, 60, 0)], CellStatus::not_seen);
    EXPECT_EQ(grid.status[pair.spec.index(60, 60, 0)], CellStatus::no_echo);
    EXPECT_EQ(grid.status[pair.spec.index(119, 60, 0)], CellStatus::no_echo);
}

// The lower sweep sees its storm at 0 s, the upper sweep sees its storm at 200 s.
TEST(GridAt, EachSweepIsMovedFromItsOwnTime) {
    const GridSpec spec = spec_of();
    const std::vector<Blob>& blobs = moving;
    Grid skewed = blob_grid(spec, blobs, 0);
    const Grid later = blob_grid(spec, blobs, 200);
    const std::vector<SweepTime> sweeps = {{0.5, start, 0, 0}, {3.5, at_second(200), 0, 0}};
    const SweepClock clock(sweeps, BeamGeometry(35, 300), start);
    const auto geometry = *make_column_geometry({"KTLX", 35, -97, 300}, spec);
    std::vector<float> seconds(3);
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            const ColumnPlace& place = geometry->row(iy)[static_cast<std::size_t>(ix)];
            clock.read(0, static_cast<double>(place.arc_m), spec.levels_m, seconds);
            for (int iz = 0; iz < 3; ++iz) {
                const std::size_t cell = spec.index(ix, iy, iz);
                const double dbz =
                    blobs_dbz(blobs, spec.x_m(ix) / 1000, spec.y_m(iy) / 1000,
                              static_cast<double>(seconds[static_cast<std::size_t>(iz)]));
                skewed.status[cell] = dbz < 0 ? CellStatus::no_echo : CellStatus::value;
                skewed.values[cell] = dbz < 0 ? 0 : static_cast<float>(dbz);
            }
        }
    }
    const auto bricks = BrickGrid::from(skewed, Pair::quantization());
    const MotionField motion({0.02F, 0.01F});
    InstantOptions options = options_at(200, TimeMethod::advected, &motion);
    const TimedView view{bricks.view(), at_second(100), sweeps};
    const Pair pair(moving, spec);
    const auto moved = grid_at(view, std::nullopt, *geometry, options);
    options.sweep_times = false;
    const auto as_one = grid_at(view, std::nullopt, *geometry, options);
    ASSERT_TRUE(moved && as_one);
    EXPECT_LT(rms_error(pair, to_dense(moved->view()), 200), 0.5);
    EXPECT_GT(rms_error(pair, to_dense(as_one->view()), 200), 1.5);
}

TEST(GridAt, SweepsOfAnotherDayCountAsNone) {
    const Pair pair(moving);
    const MotionField motion({0.02F, 0.01F});
    InstantOptions options = options_at(77, TimeMethod::advected, &motion);
    const std::vector<SweepTime> sweeps = {{0.5, start, 0, 0},
                                           {3.5, start + std::chrono::days{365}, 0, 0}};
    TimedView view = pair.early();
    const auto without = grid_at(view, std::nullopt, *pair.geometry, options);
    view.sweeps = sweeps;
    const auto with = grid_at(view, std::nullopt, *pair.geometry, options);
    ASSERT_TRUE(with && without);
    EXPECT_EQ(to_dense(with->view()).values, to_dense(without->view()).values);
}

TEST(GridAt, HasTheSameBitsOnAnyNumberOfThreads) {
    const Pair pair(moving);
    const MotionField motion({0.02F, 0.01F});
    InstantOptions options = options_at(77, TimeMethod::advected, &motion);
    const Grid alone = pair.at(options);
    options.threads = 7;
    const Grid together = pair.at(options);
    EXPECT_EQ(alone.values, together.values);
    EXPECT_EQ(alone.status, together.status);
}

TEST(GridAt, RefusesWhatDoesNotGoTogether) {
    const Pair pair(moving), other(moving, spec_of(64));
    const InstantOptions options = options_at(77, TimeMethod::blend);
    EXPECT_EQ(grid_at(other.early(), other.late(), *pair.geometry, options).error().code,
              ErrorCode::bad_argument);
    EXPECT_EQ(grid_at(pair.early(), other.late(), *pair.geometry, options).error().code,
              ErrorCode::bad_argument);
}

TEST(TimeMethod, NamesAreTheirOwnInverse) {
    for (const TimeMethod method : {TimeMethod::nearest, TimeMethod::blend, TimeMethod::advected})
        EXPECT_EQ(time_method_from_name(time_method_name(method)), method);
    EXPECT_FALSE(time_method_from_name("linear"));
}

}  // namespace
}  // namespace stormcellar::grid

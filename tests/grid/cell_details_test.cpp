// Tests the details of cells against a literal implementation of their definitions
// (tests/grid/slow_details.h), on real and synthetic volumes.
#include "stormcellar/grid/cell_details.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "grid/judge/oracle.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/slow_details.h"
#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

// as in stormcellar/grid/cell_details.h
constexpr double height_accuracy_m = 0.5;
constexpr double distance_accuracy_m = 0.5;
constexpr double age_accuracy_s = 2e-3;
constexpr double weight_accuracy = 1e-5;

DetailSet everything() {
    DetailSet set;
    for (const Detail detail : all_details)
        set.add(detail);
    return set;
}

GridderOptions asking(DetailSet set, Interpolation interpolation = Interpolation::linear) {
    GridderOptions options;
    options.beam_width_deg = 0.95;
    options.method.interpolation = interpolation;
    options.details = set;
    return options;
}

Result<Grid> grid_of(const level2::Volume& volume, const SitePosition& site, const GridSpec& spec,
                     const GridderOptions& options) {
    const auto geometry = make_column_geometry(site, spec);
    if (!geometry) return pass_on(geometry);
    return make_grid(volume, site, **geometry, options);
}

const SitePosition made_site{"XXXX", 44, 11, 300};

struct Tally {
    int columns = 0, doubtful_columns = 0;
    int seen = 0, compared = 0, partly_seen = 0, undated = 0;
};

// Returns the largest difference between the detail of a cell (`here`) and the detail of a cell 0.5
// m lower or higher.
double play(std::optional<double> low, std::optional<double> here, std::optional<double> high) {
    return std::max(std::abs(*low - *here), std::abs(*high - *here));
}

void compare_cell(const Grid& grid, const SlowColumn& slow, std::size_t cell, double level_m,
                  Tally& tally) {
    const CellDetails& details = grid.details;
    if (grid.status[cell] == CellStatus::not_seen) {
        for (const Detail detail : all_details)
            ASSERT_FALSE(details.at(detail, cell)) << "a cell that is not seen has no details";
        return;
    }
    ++tally.seen;
    const SlowDetails here = slow.at(level_m);
    const SlowDetails low = slow.at(level_m - height_accuracy_m);
    const SlowDetails high = slow.at(level_m + height_accuracy_m);
    const bool sure = low.sweeps == here.sweeps && high.sweeps == here.sweeps &&
                      low.nearest == here.nearest && high.nearest == here.nearest;
    if (!sure) return;
    ++tally.compared;
    ASSERT_TRUE(here.height_offset_m);
    const auto near = [&](Detail detail, std::optional<double> expected, double tolerance) {
        const auto found = details.at(detail, cell);
        EXPECT_EQ(found.has_value(), expected.has_value()) << detail_name(detail);
        if (!found || !expected) return;
        EXPECT_NEAR(*found, *expected, tolerance) << detail_name(detail);
    };
    near(Detail::height_offset, here.height_offset_m, height_accuracy_m);
    near(Detail::distance, here.distance_m, distance_accuracy_m);
    near(Detail::weight, here.seen, play(low.seen, here.seen, high.seen) + weight_accuracy);
    if (here.seen < 0.999) ++tally.partly_seen;
    if (!here.age_s) ++tally.undated;
    const double age_play_s = here.age_s ? play(low.age_s, here.age_s, high.age_s) : 0;
    near(Detail::age, here.age_s, age_play_s + age_accuracy_s);
}

Tally compare(const level2::Volume& volume, const SitePosition& site, const GridSpec& spec,
              const GridderOptions& options, int step) {
    Tally tally;
    const auto grid = grid_of(volume, site, spec, options);
    EXPECT_TRUE(grid);
    if (!grid) return tally;
    const auto chosen = choose_sweeps(volume, options.moment, options.beam_width_deg / 2);
    const SlowColumn::Setting setting{
        options.moment, options.beam_width_deg,
        options.method.interpolation == Interpolation::nearest,
        options.frame_time ? options.frame_time : volume.start_time()};
    for (int iy = 0; iy < spec.ny; iy += step) {
        for (int ix = iy % 3; ix < spec.nx; ix += step) {
            const SlowColumn slow(volume, chosen, setting, site, spec, ix, iy);
            ++tally.columns;
            if (slow.is_doubtful()) {
                ++tally.doubtful_columns;
                continue;
            }
            for (int iz = 0; iz < spec.nz(); ++iz) {
                compare_cell(*grid, slow, spec.index(ix, iy, iz),
                             spec.levels_m[static_cast<std::size_t>(iz)], tally);
                if (::testing::Test::HasFailure()) {
                    ADD_FAILURE() << "at " << ix << " " << iy << " " << iz;
                    return tally;
                }
            }
        }
    }
    EXPECT_LT(tally.doubtful_columns, tally.columns * 0.1) << "too few columns were compared";
    EXPECT_GT(tally.compared, tally.seen * 0.97);
    return tally;
}

class RealDetails : public ::testing::TestWithParam<const char*> {};

TEST_P(RealDetails, AreWhatTheirDefinitionsSay) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume(GetParam());
    const SitePosition site = site_of(volume);
    GridSpec spec = default_spec(site.latitude_deg, site.longitude_deg);
    const Tally near = compare(volume, site, spec, asking(everything()), 13);
    EXPECT_GT(near.compared, 3000);
    EXPECT_EQ(near.undated, 0);
    spec = square_spec(site.latitude_deg + 1.2, site.longitude_deg - 1.7, 120, 6000);
    GridderOptions options = asking(everything(), Interpolation::nearest);
    options.frame_time = *volume.start_time() + std::chrono::milliseconds(754321);
    options.threads = 2;
    const Tally far = compare(volume, site, spec, options, 7);
    EXPECT_GT(far.compared, 500);
}

INSTANTIATE_TEST_SUITE_P(Volumes, RealDetails,
                         ::testing::Values("volumes/KTLX19990503_235621.gz",
                                           "volumes/KLOT20220317_000842_V06",
                                           "volumes/KOKX20080109_141449.gz",
                                           "volumes/KCCX20130112_070503_V06.gz", "chunks/L2D_230"));

// Moves each radial off its elevation by up to `most` hundredths of a degree.
void shake_elevations(level2::Volume& volume, unsigned most, std::mt19937& random) {
    change_radials(volume, [&](level2::Radial& radial) {
        radial.elevation_deg +=
            0.01F * (static_cast<float>(random() % (2 * most + 1)) - static_cast<float>(most));
    });
}

// Returns sweeps of different reach, with a gap and some radials without times. All radials are off
// their elevation, but not enough for sweeps to change places.
level2::Volume made_volume() {
    std::mt19937 random(5);
    SweepPlan like{.first_azimuth_deg = 200.5, .first_gate_m = -375};
    std::vector<SweepPlan> plans = plans_at({-0.2, 0.5, 1.4, 2.4, 4.3, 9.9, 19.5}, like);
    for (SweepPlan& plan : plans)
        plan.gates = 445 - 45 * plan.cut;
    plans[2].radials = 300;
    level2::Volume volume = make_volume(plans);
    shake_elevations(volume, 30, random);
    for (std::size_t i = 100; i < 160; ++i)
        volume.sweeps[4].radials[i].time = UtcTime{} - std::chrono::hours(24);
    return volume;
}

TEST(CellDetails, OfMadeSweeps) {
    const GridSpec spec = square_spec(made_site.latitude_deg, made_site.longitude_deg, 150, 6100);
    const level2::Volume volume = made_volume();
    const Tally linear = compare(volume, made_site, spec, asking(everything()), 3);
    EXPECT_GT(linear.partly_seen, 300);
    EXPECT_GT(linear.undated, 300);
    compare(volume, made_site, spec, asking(everything(), Interpolation::nearest), 3);
    level2::Volume lost = volume;
    lost.vcp = 21;  // pattern 21 also has 3.35 and 6 degrees
    compare(lost, made_site, spec, asking(everything()), 3);
}

// Covers high and low sites all over the earth, elevations from -5 to 60 degrees and ranges to 470
// km.
TEST(CellDetails, OfSweepsFromSitesAllOverTheEarth) {
    SweepPlan like{.gates = 471, .first_gate_m = -1};
    level2::Volume volume =
        make_volume(plans_at({-5.0, -0.5, 0.0, 0.5, 1.5, 9.9, 19.5, 60.0}, like));
    std::mt19937 random(6);
    shake_elevations(volume, 20, random);
    for (const SitePosition& site :
         {SitePosition{"XXXX", 78, 15.5, -100}, SitePosition{"XXXX", 0, 180, 4000},
          SitePosition{"XXXX", -71, -180, 300}}) {
        const GridSpec spec = square_spec(site.latitude_deg, site.longitude_deg, 68, 13'700);
        const Tally tally = compare(volume, site, spec, asking(everything()), 4);
        EXPECT_GT(tally.compared, 1000) << site.latitude_deg;
    }
}

TEST(CellDetails, ACellAtAGatesCentreIsAtTheGate) {
    const SitePosition site{"KTLX", 35.3333, -97.2778, 389};
    SweepPlan plan;
    plan.elevation_deg = 1.5;
    plan.first_azimuth_deg = 90;  // so that radial 0 looks east
    const level2::Volume volume = make_volume({plan});
    const BeamGeometry beam(site.latitude_deg, site.altitude_m);
    const EarthPoint gate = beam.forward({100e3, 1.5});
    GridSpec spec = default_spec(site.latitude_deg, site.longitude_deg);
    spec.nx = 3;  // about the site: the last column is due east of it
    spec.ny = 1;
    spec.spacing_m = gate.arc_m;
    spec.levels_m = {gate.height_m, gate.height_m + 300};
    GridderOptions options = asking(everything());
    options.frame_time = volume.sweeps[0].radials[0].time + std::chrono::milliseconds(2500);
    const auto grid = grid_of(volume, site, spec, options);
    ASSERT_TRUE(grid);
    const std::size_t at = spec.index(2, 0, 0);
    EXPECT_LT(grid->details.at(Detail::distance, at), 0.5F);
    EXPECT_NEAR(*grid->details.at(Detail::height_offset, at), 0, 0.5);
    EXPECT_EQ(grid->details.at(Detail::age, at), -2.5F);
    EXPECT_EQ(grid->details.at(Detail::weight, at), 1.0F);
    EXPECT_NEAR(*grid->details.at(Detail::height_offset, at + 1), 300, 0.5);
    EXPECT_NEAR(*grid->details.at(Detail::distance, at + 1), 300, 0.5);
    EXPECT_EQ(grid->frame_time, options.frame_time);
}

TEST(CellDetails, OnlyWhatIsAskedForIsThere) {
    const GridSpec spec = square_spec(made_site.latitude_deg, made_site.longitude_deg, 31, 20e3);
    const level2::Volume volume = made_volume();
    const auto nothing = grid_of(volume, made_site, spec, asking({}));
    const auto all = grid_of(volume, made_site, spec, asking(everything()));
    ASSERT_TRUE(nothing && all);
    EXPECT_EQ(nothing->details.size(), 0U);
    EXPECT_FALSE(nothing->details.set().any());
    EXPECT_EQ(nothing->status, all->status);
    EXPECT_EQ(nothing->values, all->values);
    EXPECT_FALSE(nothing->frame_time);
    for (const Detail only : all_details) {
        DetailSet set;
        set.add(only);
        const auto one = grid_of(volume, made_site, spec, asking(set));
        ASSERT_TRUE(one);
        ASSERT_EQ(one->details.size(), spec.cell_count());
        for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
            for (const Detail detail : all_details) {
                const auto expected = detail == only ? all->details.at(detail, cell) : std::nullopt;
                ASSERT_EQ(one->details.at(detail, cell), expected) << detail_name(detail);
            }
        }
    }
}

TEST(CellDetails, WithoutATimeThereAreNoAges) {
    const GridSpec spec = square_spec(made_site.latitude_deg, made_site.longitude_deg, 21, 20e3);
    level2::Volume volume = made_volume();
    change_radials(
        volume, [&](level2::Radial& radial) { radial.time = UtcTime{} - std::chrono::hours(24); });
    const auto grid = grid_of(volume, made_site, spec, asking(everything()));
    ASSERT_TRUE(grid);
    int seen = 0;
    for (std::size_t cell = 0; cell < spec.cell_count(); ++cell) {
        EXPECT_FALSE(grid->details.at(Detail::age, cell));
        if (grid->details.at(Detail::distance, cell)) ++seen;
    }
    EXPECT_GT(seen, 500);
}

// Tests the weights of methods that mix several gates, against the gridder's oracle.
class MixedWeights : public ::testing::TestWithParam<std::pair<Interpolation, CellExtent>> {};

TEST_P(MixedWeights, AreTheShareThatWasSeen) {
    const GridSpec spec = square_spec(made_site.latitude_deg, made_site.longitude_deg, 130, 6100);
    const level2::Volume volume = made_volume();
    GridderOptions options = asking(everything(), GetParam().first);
    options.method.cell = GetParam().second;
    const auto grid = grid_of(volume, made_site, spec, options);
    ASSERT_TRUE(grid);
    const auto chosen = choose_sweeps(volume, level2::Moment::ref, 0.475);
    const OracleSetting setting{level2::Moment::ref, 0.95, false, options.method, {}};
    const bool area = GetParam().second == CellExtent::area;
    int partly_seen = 0;
    for (int iy = 0; iy < spec.ny; iy += area ? 29 : 11) {
        for (int ix = iy % 3; ix < spec.nx; ix += 7) {
            const OracleColumn slow(volume, chosen, setting, made_site, spec, ix, iy);
            if (slow.is_doubtful()) continue;
            for (std::size_t level = 0; level < spec.levels_m.size(); ++level) {
                const std::size_t cell = spec.index(ix, iy, static_cast<int>(level));
                const auto weight = grid->details.at(Detail::weight, cell);
                ASSERT_EQ(weight.has_value(), grid->status[cell] != CellStatus::not_seen);
                if (!weight) continue;
                const double here = slow.cell(level).unseen;
                const double tolerance =
                    play(slow.cell(level, -1).unseen, here, slow.cell(level, 1).unseen) +
                    (area ? 0.02 : 1e-4);
                EXPECT_NEAR(*weight, 1 - here, tolerance) << ix << " " << iy << " " << level;
                if (here > 0.001) ++partly_seen;
                const auto distance = grid->details.at(Detail::distance, cell);
                const auto offset = grid->details.at(Detail::height_offset, cell);
                EXPECT_EQ(distance.has_value(), offset.has_value());
            }
        }
    }
    EXPECT_GT(partly_seen, 100);
}

INSTANTIATE_TEST_SUITE_P(Methods, MixedWeights,
                         ::testing::Values(std::pair{Interpolation::eight_point, CellExtent::point},
                                           std::pair{Interpolation::beam_weighted,
                                                     CellExtent::point},
                                           std::pair{Interpolation::linear, CellExtent::area}));

TEST(CellDetails, HaveNames) {
    for (const Detail detail : all_details)
        EXPECT_EQ(detail_from_name(detail_name(detail)), detail);
    EXPECT_EQ(detail_from_name("Age"), std::nullopt);
    EXPECT_EQ(detail_from_name(""), std::nullopt);
}

TEST(FrameTime, OfAGridNamesTheSweepsThatItIsMadeOf) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("chunks/L2D_230");
    const SitePosition site = site_of(volume);
    const GridSpec spec = square_spec(site.latitude_deg, site.longitude_deg, 100, 4000);
    DetailSet ages;
    ages.add(Detail::age);
    GridderOptions options = asking(ages);
    const auto note_of = [](const Grid& grid, const std::string& part) {
        return std::count_if(
            grid.provenance.notes.begin(), grid.provenance.notes.end(),
            [&](const std::string& note) { return note.find(part) != std::string::npos; });
    };
    const auto newest = grid_of(volume, site, spec, options);
    ASSERT_TRUE(newest);
    EXPECT_EQ(note_of(*newest, "2 sweeps at 0.5 degrees: the newest was taken, of 2021-07-29T"), 1);
    EXPECT_EQ(note_of(*newest, "2 sweeps at"), 2) << "0.5 and 0.9 degrees have two sweeps each";
    options.repeats = GridderOptions::Repeats::nearest_in_time;
    options.frame_time = *volume.start_time() + std::chrono::seconds(5);
    const auto first = grid_of(volume, site, spec, options);
    ASSERT_TRUE(first);
    EXPECT_EQ(note_of(*first, "2 sweeps at 0.5 degrees: the nearest to " +
                                  format_utc(*options.frame_time) + " was taken"),
              1);
    EXPECT_EQ(first->time, newest->time);
    EXPECT_EQ(first->frame_time, options.frame_time);
    // At 20 km east and a height of 500 m, only the lowest sweeps see the cell.
    const std::size_t low = spec.index(55, 50, 0);
    ASSERT_TRUE(first->details.at(Detail::age, low) && newest->details.at(Detail::age, low));
    EXPECT_LT(*first->details.at(Detail::age, low), 40);
    EXPECT_GT(*newest->details.at(Detail::age, low), 100);
    options.frame_time = UtcTime{} - std::chrono::hours(1);
    const auto never = grid_of(volume, site, spec, options);
    ASSERT_FALSE(never);
    EXPECT_EQ(never.error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::grid

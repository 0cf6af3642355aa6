// Compares simulated radars that see the same storms, gridded as the daemon does it.
#include "pipeline/mosaic/site_watch.h"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/mosaic/mosaic_maker.h"
#include "synth/observe.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/two_radars.h"

namespace stormcellar::pipeline {
namespace {

using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Domain plains() {
    Domain domain;
    domain.name = "plains";
    domain.spec = grid::default_spec(35, -97);
    domain.spec.nx = 300;
    domain.spec.ny = 320;
    domain.spec.levels_m.resize(24);
    return domain;
}

struct Radar {
    grid::SitePosition site;
    std::vector<level2::Volume> volumes;
};

Radar radar_at(const char* station, double longitude_deg, unsigned seed) {
    const auto scene =
        synth::parse_scene(testing::scene_of_nine_storms(station, longitude_deg, seed, 2), station);
    EXPECT_TRUE(scene) << scene.error().message;
    return {{station, 35, longitude_deg, 380},
            {synth::observe(*scene, 0), synth::observe(*scene, 1)}};
}

void delay(level2::Volume& volume, std::chrono::milliseconds by) {
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials)
            radial.time += by;
    }
}

void weaken(level2::Volume& volume, float by_db) {
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::SweepMoment& moment : sweep.moments)
            moment.offset += by_db * moment.scale;
    }
}

class SiteWatchTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        a_ = new Radar(radar_at("XSYA", -97.6, 1));
        b_ = new Radar(radar_at("XSYB", -96.4, 2));
    }
    static void TearDownTestSuite() {
        delete a_;
        delete b_;
    }
    void take(const Radar& radar, std::size_t volume) {
        VolumeSource source{radar.volumes.at(volume), radar.site, "made"};
        const auto kept = keeper_.take_in(source, 2);
        EXPECT_TRUE(kept) << kept.error().message;
    }
    std::optional<PairReport> next() {
        const auto report = watch_.compare_next();
        EXPECT_TRUE(report) << report.error().message;
        if (*report) fmt::print("{}\n", describe((*report)->found));
        return *report;
    }
    // Expects the true values, within the accuracy that grid/judge/site_comparison.h states.
    static void expect(const grid::SiteComparison& found, double bias_db, double azimuth_deg,
                       double time_s) {
        EXPECT_NEAR(found.bias_db.value, bias_db, 0.4);
        EXPECT_NEAR(found.azimuth_deg.value, azimuth_deg, 0.12);
        EXPECT_NEAR(found.elevation_deg.value, 0, 0.15);
        EXPECT_NEAR(found.time_s.value, time_s, 12);
        EXPECT_THAT(untold(found), IsEmpty());
    }

    static inline Radar* a_ = nullptr;
    static inline Radar* b_ = nullptr;
    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    MosaicMaker keeper_{&store_, {plains()}};
    SiteWatch watch_{store_, {plains()}};
};

TEST_F(SiteWatchTest, SitesAreComparedOnceAFrameIsComplete) {
    EXPECT_FALSE(next()) << "the cache is empty";
    take(*a_, 0);
    take(*b_, 0);
    EXPECT_FALSE(next()) << "the frame is still provisional";
    take(*a_, 1);
    EXPECT_FALSE(next());
    take(*b_, 1);
    const auto report = next();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->domain, "plains");
    EXPECT_EQ(format_utc(report->instant), "2024-06-01T22:05:00Z");
    EXPECT_EQ(report->found.a, "XSYA");
    EXPECT_EQ(report->found.b, "XSYB");
    expect(report->found, 0, 0, 0);
    EXPECT_THAT(report->faults, IsEmpty());
    EXPECT_FALSE(next()) << "a pair should be compared once an hour";
}

TEST_F(SiteWatchTest, AFaultIsNamed) {
    Radar weak = *b_;
    for (level2::Volume& volume : weak.volumes)
        weaken(volume, 2);
    for (const std::size_t volume : {0U, 1U}) {
        take(*a_, volume);
        take(weak, volume);
    }
    const auto report = next();
    ASSERT_TRUE(report);
    expect(report->found, -2, 0, 0);
    EXPECT_THAT(report->faults, ElementsAre(HasSubstr("XSYB against XSYA: too weak by ")));
}

// The motion is estimated from the volumes, so that a wrong clock can be told from a misaligned
// antenna.
TEST_F(SiteWatchTest, AClockThatIsLateIsNamed) {
    Radar late = *b_;
    for (level2::Volume& volume : late.volumes)
        delay(volume, std::chrono::seconds{-30});
    for (const std::size_t volume : {0U, 1U}) {
        take(*a_, volume);
        take(late, volume);
    }
    const auto report = next();
    ASSERT_TRUE(report);
    expect(report->found, 0, 0, 30);
    EXPECT_THAT(report->faults, ElementsAre(HasSubstr("XSYB against XSYA: clock late by ")));
}

TEST_F(SiteWatchTest, AnHourLaterTheyAreComparedAgainAndNotBefore) {
    const auto take_all = [&](minutes later) {
        for (const Radar* radar : {a_, b_}) {
            Radar shifted = *radar;
            for (const std::size_t volume : {0U, 1U}) {
                delay(shifted.volumes[volume], later);
                take(shifted, volume);
            }
        }
    };
    take_all(minutes{0});
    EXPECT_TRUE(next());
    take_all(minutes{55});
    EXPECT_FALSE(next());
    take_all(minutes{65});
    const auto report = next();
    ASSERT_TRUE(report);
    EXPECT_EQ(format_utc(report->instant), "2024-06-01T23:10:00Z");
}

TEST_F(SiteWatchTest, ADamagedPartialIsNotCompared) {
    for (const std::size_t volume : {0U, 1U}) {
        take(*a_, volume);
        take(*b_, volume);
    }
    const auto partials =
        *store_.list("plains.XSYB", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_EQ(partials.size(), 2U);
    for (const auto& partial : partials) {
        std::fstream file(partial.path, std::ios::binary | std::ios::in | std::ios::out);
        file.seekg(-1, std::ios::end);
        const char last = static_cast<char>(file.get() ^ 1);
        file.seekp(-1, std::ios::end);
        file.put(last);
    }
    EXPECT_FALSE(next());
}

TEST_F(SiteWatchTest, ADomainWithoutReflectivityHasNothingToCompare) {
    Domain velocity = plains();
    velocity.moments = {level2::Moment::vel};
    SiteWatch watch(store_, {velocity});
    const auto report = watch.compare_next();
    ASSERT_TRUE(report);
    EXPECT_FALSE(*report);
}

TEST(MayOverlap, IsByTheRangeOfBoth) {
    const grid::SitePosition here{"XSYA", 35, -97, 380};
    EXPECT_TRUE(may_overlap(here, {"XSYB", 35, -92.7, 380}));   // 392 km
    EXPECT_FALSE(may_overlap(here, {"XSYB", 35, -92.5, 380}));  // 410 km
}

}  // namespace
}  // namespace stormcellar::pipeline

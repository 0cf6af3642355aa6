// Tests the places of sweeps: kinds, repeated and dropped cuts, gates.
#include "web/data/station/sweep_places.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/web/made_sweeps.h"
#include "web/data/station/moment_names.h"

namespace stormcellar::web {
namespace {

using level2::Moment;

constexpr VolumeSize any_size{1, 1};

// Returns the places of the sweeps of a volume by their indices; -1: none.
std::vector<int> places_of(const SweepPlaces& places, const level2::Volume& volume) {
    std::vector<int> found(volume.sweeps.size(), -1);
    for (std::size_t place = 0; place < places.all().size(); ++place) {
        const level2::Sweep* const sweep = places.find(volume, place);
        if (sweep == nullptr) continue;
        found[static_cast<std::size_t>(sweep - volume.sweeps.data())] = static_cast<int>(place);
    }
    return found;
}

// The largest volume repeats the low cuts twice (SAILS), another one once, elsewhere (MRLE), and
// the last one ends early (AVSET). A Doppler cut is another kind than the cut below it.
TEST(SweepPlaces, RepeatedAndDroppedSweepsKeepTheirPlaces) {
    const CutPlan low{0.5}, doppler{0.5, true}, middle{4}, high{10};
    SweepPlaces places;
    places.learn(made_volume({low, doppler, middle, low, doppler, high, low}), {7, 7});
    EXPECT_EQ(places.all().size(), 7U);
    EXPECT_EQ(places.all()[3].occurrence, 1);
    const auto of = [&](const std::vector<CutPlan>& cuts) {
        return places_of(places, made_volume(cuts));
    };
    EXPECT_EQ(of({low, doppler, middle, low, doppler, high, low}),
              (std::vector{0, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(of({low, doppler, low, doppler, middle, high}), (std::vector{0, 1, 3, 4, 2, 5}));
    EXPECT_EQ(of({low, doppler, low, low, high}), (std::vector{0, 1, 3, 6, 5}));
    EXPECT_EQ(of({low, doppler, middle}), (std::vector{0, 1, 2}));
    EXPECT_EQ(of({low, {7}, high}), (std::vector{0, -1, 5})) << "nobody learned 7 degrees";
}

TEST(SweepPlaces, PlacesThatAreLearnedLaterComeLast) {
    SweepPlaces places;
    places.learn(made_volume({{0.5}, {4}}), any_size);
    places.learn(made_volume({{0.5}, {2}, {4}, {0.5}}), {2, 2});
    EXPECT_EQ(places_of(places, made_volume({{0.5}, {2}, {4}, {0.5}})), (std::vector{0, 2, 1, 3}));
}

TEST(SweepPlaces, AnglesWithinTheToleranceAreOneKindAndTheNearestWins) {
    SweepPlaces places;
    places.learn(made_volume({{0.5}, {0.7}}), any_size);
    ASSERT_EQ(places.all().size(), 2U);
    EXPECT_EQ(places_of(places, made_volume({{0.62}})), (std::vector{1}));
    EXPECT_EQ(places_of(places, made_volume({{0.4}})), (std::vector{0}));
    EXPECT_EQ(places_of(places, made_volume({{0.3}})), (std::vector{-1}));
}

TEST(SweepPlaces, ARestartedCutCountsOnceWithTheMostRadials) {
    SweepPlaces places;
    level2::Volume volume = made_volume({{0.5}, {0.5}, {4}});
    volume.sweeps[1].elevation_number = 1;
    volume.sweeps[0].radials.resize(100);
    volume.sweeps[2].elevation_number = 2;
    places.learn(volume, any_size);
    EXPECT_EQ(places_of(places, volume), (std::vector{-1, 0, 1}));
}

TEST(SweepPlaces, ACutIsKnownUnlessItsKindMustBeCounted) {
    SweepPlaces places;
    places.learn(made_volume({{0.5}, {4}, {0.5}}), any_size);
    EXPECT_EQ(places.cut_of(any_size, 0), 1);
    EXPECT_EQ(places.cut_of(any_size, 1), 2);
    EXPECT_EQ(places.cut_of(any_size, 2), std::nullopt) << "the sweep before it must be counted";
    EXPECT_EQ(places.cut_of({2, 2}, 0), std::nullopt);
}

// REF has gates of 1 km, VEL of 250 m that begin and end at them; SW begins elsewhere.
TEST(SweepPlaces, GatesThatFitShareTheFinestAxisAndOthersHaveTheirOwn) {
    level2::Volume volume = made_volume({{0.5, true}});
    level2::Sweep& sweep = volume.sweeps.front();
    sweep.moments.clear();
    add_moment(sweep, Moment::ref, 0, 1000, 10);
    add_moment(sweep, Moment::vel, -375, 250, 24);
    add_moment(sweep, Moment::sw, 0, 250, 8);
    SweepPlaces places;
    places.learn(volume, any_size);
    const SweepPlace& place = places.all().front();
    ASSERT_EQ(place.axes.size(), 2U);
    EXPECT_EQ(place.axes[0].name, "range");
    EXPECT_EQ(place.axes[0].gates, 40U);
    EXPECT_EQ(place.axes[1].name, "range_WRADH");
    EXPECT_EQ(place.moments[2].axis, "range_WRADH");
    EXPECT_EQ(repeats_on(sweep.moments[0], -375, 250), 4);
    EXPECT_EQ(repeats_on(sweep.moments[0], 0, 0), 0);
}

// 2026-11-29: the oldest volume of an archive had longer radials than the newest one.
TEST(SweepPlaces, FurtherVolumesAddGatesAndMoments) {
    SweepPlaces places;
    places.learn(made_volume({{4}}), any_size);
    level2::Volume longer = made_volume({{4}});
    longer.sweeps[0].moments.clear();
    add_moment(longer.sweeps[0], Moment::ref, 0, 250, 500);
    add_moment(longer.sweeps[0], Moment::zdr, 0, 250, 500);
    places.learn(longer, any_size);
    ASSERT_EQ(places.all().size(), 1U);
    EXPECT_EQ(places.all()[0].axes[0].gates, 500U);
    EXPECT_EQ(places.all()[0].moments.size(), 2U);
}

TEST(SweepPlaces, AHostilePatternHasALimit) {
    std::vector<CutPlan> cuts;
    for (int i = 0; i < 400; ++i)
        cuts.push_back({0.2 * i});
    SweepPlaces places;
    places.learn(made_volume(cuts), any_size);
    EXPECT_EQ(places.all().size(), SweepPlaces::most);
}

TEST(SweepPlaces, SizesAreRoundedAsPythonRoundsThem) {
    EXPECT_EQ(size_of_volume(9, 540), (VolumeSize{9, 2}));
    EXPECT_EQ(size_of_volume(9, 900), (VolumeSize{9, 2}));
    EXPECT_EQ(size_of_volume(9, 901), (VolumeSize{9, 3}));
}

TEST(MomentNames, EveryMomentHasAName) {
    for (const level2::MomentFacts& facts : level2::moment_facts)
        EXPECT_NE(fm301_names(facts.moment).name, "");
    EXPECT_EQ(fm301_names(Moment::ref).name, "DBZH");
}

}  // namespace
}  // namespace stormcellar::web

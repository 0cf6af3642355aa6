// Tests the chunks of one sweep: the radial of each azimuth, and its gates.
#include "web/data/station/sweep_chunks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/web/made_sweeps.h"

namespace stormcellar::web {
namespace {

using level2::GateStatus;
using level2::Moment;

template <class Number>
std::vector<Number> numbers_of(const std::optional<std::string>& bytes) {
    std::vector<Number> numbers(bytes ? bytes->size() / sizeof(Number) : 0);
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes->data(), bytes->size());
    return numbers;
}

SweepPlace place_of(const level2::Volume& volume) {
    SweepPlaces places;
    places.learn(volume, {1, 1});
    return places.all().at(0);
}

TEST(SweepChunks, EachAzimuthHasTheNearestRadialAndNoneThatIsFar) {
    level2::Volume volume = made_volume({{0.5}});
    std::vector<level2::Radial>& radials = volume.sweeps[0].radials;
    for (level2::Radial& radial : radials)
        radial.azimuth_deg = std::fmod(radial.azimuth_deg + 359.7F, 360.0F);  // 0.2, 1.2 ... 359.2
    radials.erase(radials.begin() + 30, radials.begin() + 40);
    level2::Sweep& sweep = volume.sweeps[0];
    sweep.moments.clear();
    add_moment(sweep, Moment::ref, 0, 250, 4);
    const SweepPlace place = place_of(volume);
    const auto found = radials_of(sweep, place);
    ASSERT_EQ(found.size(), 360U);
    for (std::size_t azimuth = 0; azimuth < 360; ++azimuth) {
        // The slow way: look at all radials.
        int nearest = -1;
        double least_deg = 0.75;
        for (std::size_t i = 0; i < radials.size(); ++i) {
            const double apart = std::abs(std::remainder(
                double{radials[i].azimuth_deg} - (static_cast<double>(azimuth) + 0.5), 360.0));
            if (apart <= least_deg) nearest = static_cast<int>(i), least_deg = apart;
        }
        EXPECT_EQ(found[azimuth], nearest) << azimuth;
    }
    EXPECT_EQ(std::ranges::count(found, -1), 9) << "one azimuth has a radial 0.7 degrees away";
    const auto states = numbers_of<std::uint8_t>(sweep_states(sweep, place, place.moments[0]));
    const auto values = numbers_of<float>(sweep_values(sweep, place, place.moments[0]));
    const auto times = numbers_of<std::int64_t>(radial_facts(sweep, place, RadialFact::time));
    const auto azimuths = numbers_of<float>(radial_facts(sweep, place, RadialFact::azimuth));
    for (std::size_t row = 0; row < 360; ++row) {
        const bool is_there = found[row] >= 0;
        EXPECT_EQ(states[row * 4] == static_cast<int>(GateStatus::no_data), !is_there);
        EXPECT_EQ(std::isnan(values[row * 4]), !is_there);
        EXPECT_EQ(times[row] == no_time_ms, !is_there);
        EXPECT_EQ(std::isnan(azimuths[row]), !is_there);
    }
}

TEST(SweepChunks, LongGatesAreRepeatedAndShortRadialsAreFilled) {
    level2::Volume volume = made_volume({{0.5, true}});
    level2::Sweep& sweep = volume.sweeps[0];
    sweep.moments.clear();
    add_moment(sweep, Moment::ref, 0, 1000, 2);
    add_moment(sweep, Moment::vel, -375, 250, 10);
    sweep.moments[0].codes8[0] = 0;       // below the threshold
    sweep.moments[0].gate_counts[1] = 1;  // of two
    const SweepPlace place = place_of(volume);
    const auto values = numbers_of<float>(sweep_values(sweep, place, place.moments[0]));
    const auto states = numbers_of<std::uint8_t>(sweep_states(sweep, place, place.moments[0]));
    ASSERT_EQ(values.size(), 360U * 10);
    const float second = sweep.moments[0].value_of(sweep.moments[0].codes8[1]);
    for (std::size_t gate = 0; gate < 10; ++gate) {
        const GateStatus first_row = gate < 4   ? GateStatus::below_threshold
                                     : gate < 8 ? GateStatus::valid
                                                : GateStatus::no_data;
        EXPECT_EQ(states[gate], static_cast<int>(first_row)) << gate;
        EXPECT_TRUE(gate >= 4 && gate < 8 ? values[gate] == second : std::isnan(values[gate]));
        EXPECT_EQ(states[10 + gate] == static_cast<int>(GateStatus::valid), gate < 4) << gate;
    }
}

TEST(SweepChunks, AMissingMomentAndOtherGatesGiveNoChunk) {
    const level2::Volume volume = made_volume({{0.5}});
    const SweepPlace place = place_of(volume);
    EXPECT_TRUE(sweep_values(volume.sweeps[0], place, place.moments[0]));
    level2::Sweep other = volume.sweeps[0];
    other.moments[0].first_gate_m = 100;
    EXPECT_FALSE(sweep_values(other, place, place.moments[0]));
    other.moments.clear();
    EXPECT_FALSE(sweep_states(other, place, place.moments[0]));
}

// The arrays of a place may be shorter than the radials of a volume that nobody learned.
TEST(SweepChunks, GatesBeyondTheAxisAreLeftOut) {
    level2::Volume volume = made_volume({{0.5}});
    const SweepPlace place = place_of(volume);
    level2::Sweep& sweep = volume.sweeps[0];
    sweep.moments.clear();
    add_moment(sweep, Moment::ref, 0, 250, 9);
    const auto values = numbers_of<float>(sweep_values(sweep, place, place.moments[0]));
    ASSERT_EQ(values.size(), 360U * 4);
    EXPECT_EQ(values[4], sweep.moments[0].value_of(sweep.moments[0].codes8[9]));
}

TEST(SweepChunks, HalfDegreesHaveTheirOwnAxis) {
    const level2::Volume volume = made_volume({{0.5, false, 0.5}});
    const SweepPlace place = place_of(volume);
    const auto azimuths = azimuths_of(place);
    EXPECT_EQ(azimuths.size(), 720U);
    EXPECT_EQ(azimuths[1], 0.75);
    const auto radials = radials_of(volume.sweeps[0], place);
    for (std::size_t i = 0; i < radials.size(); ++i)
        ASSERT_EQ(radials[i], static_cast<int>(i));
}

}  // namespace
}  // namespace stormcellar::web

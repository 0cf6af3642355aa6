// Tests each effect alone against its closed form.
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "synth/counter_random.h"
#include "synth/synth_effects.h"

namespace stormcellar::synth {
namespace {

constexpr double no_echo_dbz = -std::numeric_limits<double>::infinity();

double normal(std::uint32_t index) {
    const RandomWords words = draw(3, Draw::gate, {0, 0, 0, index});
    return normals_of(words[0], words[1]).first;
}

struct Moments {
    double mean = 0;
    double deviation = 0;
};
template <typename Value>
Moments moments_of(int count, Value value) {
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < count; ++i) {
        const double x = value(static_cast<std::uint32_t>(i));
        sum += x;
        squares += x * x;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(Noise, FarAboveTheNoiseItDeviatesBySoManyDecibels) {
    for (const double noise_db : {0.5, 1.0, 2.0}) {
        const Moments db = moments_of(
            100000, [&](std::uint32_t i) { return noisy_dbz(50, -30, noise_db, normal(i)); });
        EXPECT_NEAR(db.deviation, noise_db, 0.01 * noise_db);
        const Moments z = moments_of(100000, [&](std::uint32_t i) {
            return std::pow(10, (noisy_dbz(50, -30, noise_db, normal(i)) - 50) / 10);
        });
        EXPECT_NEAR(z.mean, 1, 0.01) << "the mean in linear Z is right";
    }
}

TEST(Noise, GrowsAsTheSignalSinksIntoIt) {
    const double k = std::numbers::ln10 / 10;
    for (const double snr_db : {20.0, 10.0, 5.0, 3.0}) {
        const double over = 1 + std::pow(10, -snr_db / 10);
        // An estimate of negative power cannot be written in decibels, but it counts in the mean.
        const Moments z = moments_of(100000, [&](std::uint32_t i) {
            const double dbz = noisy_dbz(snr_db, 0, 1, normal(i));
            return dbz == no_echo_dbz ? 0 : std::pow(10, (dbz - snr_db) / 10);
        });
        EXPECT_NEAR(z.mean, 1, 0.01) << snr_db;
        EXPECT_NEAR(z.deviation, over * std::sqrt(std::expm1(k * k)), 0.02 * over) << snr_db;
    }
}

TEST(Noise, AloneItSeldomPassesAThreshold) {
    // exp(k g - k^2 / 2) - 1 >= 10^(2 / 10) needs g = (ln(2.585) + k^2 / 2) / k; k = 0.46.
    const double k = 2 * std::numbers::ln10 / 10;
    const double needed = (std::log(1 + std::pow(10, 0.2)) + k * k / 2) / k;
    EXPECT_LT(noisy_dbz(no_echo_dbz, -20, 2, needed - 1e-6), -18);
    EXPECT_GT(noisy_dbz(no_echo_dbz, -20, 2, needed + 1e-6), -18);
    EXPECT_EQ(noisy_dbz(no_echo_dbz, -20, 2, -1), no_echo_dbz);
    EXPECT_NEAR(noisy_dbz(35, -20, 0, 3), 35, 1e-4) << "without a deviation, nothing changes";
}

TEST(Noise, OfVelocitiesDoublesWhereSignalEqualsNoise) {
    EXPECT_NEAR(velocity_deviation_mps(40, -20, 1.5), 1.5, 1e-5);
    EXPECT_DOUBLE_EQ(velocity_deviation_mps(-20, -20, 1.5), 3);
}

TEST(VelocityFolding, IsAMultipleOfTheIntervalOffAndInside) {
    for (const double nyquist : {8.32, 28.34, 33.21}) {
        EXPECT_DOUBLE_EQ(wrapped_mps(0, nyquist), 0);
        EXPECT_DOUBLE_EQ(wrapped_mps(nyquist, nyquist), -nyquist)
            << "the interval excludes its upper end";
        EXPECT_DOUBLE_EQ(wrapped_mps(-nyquist, nyquist), -nyquist);
        EXPECT_NEAR(wrapped_mps(nyquist + 1, nyquist), -nyquist + 1, 1e-12);
        EXPECT_NEAR(wrapped_mps(-nyquist - 1, nyquist), nyquist - 1, 1e-12);
        for (double velocity = -150; velocity < 150; velocity += 0.37) {
            const double wrapped = wrapped_mps(velocity, nyquist);
            EXPECT_GE(wrapped, -nyquist);
            EXPECT_LT(wrapped, nyquist);
            const double turns = (velocity - wrapped) / (2 * nyquist);
            EXPECT_NEAR(turns, std::round(turns), 1e-12);
        }
        EXPECT_LT(wrapped_mps(std::nextafter(-nyquist, -1e9), nyquist), nyquist);
    }
}

TEST(VelocityFolding, TheFoldNumberRestoresTheVelocity) {
    EXPECT_EQ(fold_number(3, 3, 10), 0);
    EXPECT_EQ(fold_number(18, -2, 10), 1);
    EXPECT_EQ(fold_number(-41, -1, 10), -2);
    EXPECT_EQ(fold_number(9.9, -9.5, 10), 1) << "noise of 0.6 m/s folded the velocity";
    for (const double nyquist : {2.0, 8.32, 63.0}) {
        for (double velocity = -150; velocity < 150; velocity += 0.37) {
            const double wrapped = wrapped_mps(velocity, nyquist);
            EXPECT_NEAR(wrapped + 2 * nyquist * fold_number(velocity, wrapped, nyquist), velocity,
                        1e-12);
        }
    }
}

TEST(RangeFolding, AGateIsFoldedUnlessItTowersOverTheOtherTrips) {
    std::vector<double> power(20, 0);
    power[2] = 10;  // the only echo of gates 2, 9 and 16
    power[3] = 1;   // as strong as gate 10, so both are folded
    power[10] = 1;
    power[4] = 100;  // 20 dB above gate 11
    power[11] = 1;
    power[5] = 3;  // 4.8 dB above the sum of gates 12 and 19
    power[12] = 0.5;
    power[19] = 0.5;
    const auto folded = overlaid_gates(power, 7, 5);
    for (std::size_t gate = 0; gate < power.size(); ++gate) {
        const bool expected =
            gate == 3 || gate == 10 || gate == 11 || gate == 5 || gate == 12 || gate == 19;
        EXPECT_EQ(folded[gate], expected) << gate;
    }
    EXPECT_FALSE(overlaid_gates(power, 7, 4.7)[5]);
}

TEST(Clutter, FallsWithRangeAndElevation) {
    Clutter clutter{50, 30000, 0};
    EXPECT_DOUBLE_EQ(clutter_dbz(clutter, 1, {10, 0, 1}, 0), 50);
    EXPECT_DOUBLE_EQ(clutter_dbz(clutter, 1, {10, 0, 1}, 30000), 10);
    EXPECT_DOUBLE_EQ(clutter_dbz(clutter, 1, {10, -0.4, 1}, 15000), 30)
        << "a beam below the horizon has no more clutter than a beam on it";
    // At half a beam width above the axis the pattern is a half, so both ways together lose 6.02
    // dB.
    EXPECT_NEAR(clutter_dbz(clutter, 1, {10, 0.5, 1}, 15000), 30 - 20 * std::log10(2), 1e-9);
    EXPECT_EQ(clutter_dbz(clutter, 1, {10, 2, 1}, 15000), no_echo_dbz);
    EXPECT_EQ(clutter_dbz(clutter, 1, {10, 0, 1}, clutter_reach_m(clutter) + 1), no_echo_dbz);
}

TEST(Clutter, ItsTextureBelongsToTheGround) {
    const Clutter clutter{50, 30000, 6};
    EXPECT_EQ(clutter_dbz(clutter, 1, {10.1, 0, 1}, 5000),
              clutter_dbz(clutter, 1, {10.4, 0, 1}, 5000));
    EXPECT_NE(clutter_dbz(clutter, 1, {10.1, 0, 1}, 5000),
              clutter_dbz(clutter, 2, {10.1, 0, 1}, 5000));
    const Moments db = moments_of(20000, [&](std::uint32_t i) {
        const double azimuth_deg = 0.5 * (i % 720) + 0.25;
        const std::uint32_t gate = i / 720;
        const double range_m = 125 + 250 * gate;
        return clutter_dbz(clutter, 1, {azimuth_deg, 0, 1}, range_m) - 50 + 40 * range_m / 30000;
    });
    EXPECT_NEAR(db.mean, 0, 4 * 6 / std::sqrt(20000));
    EXPECT_NEAR(db.deviation, 6, 0.15);
}

TEST(SumOfEchoes, IsThatOfTheTwoSpectra) {
    const GateEcho sum = sum_of({30, 10, 2}, {30, -10, 1});
    EXPECT_NEAR(sum.dbz, 30 + 10 * std::log10(2), 1e-12);
    EXPECT_NEAR(sum.away_mps, 0, 1e-12);
    EXPECT_NEAR(sum.width_mps, std::sqrt(2.5 + 100), 1e-12);
    EXPECT_EQ(sum_of({no_echo_dbz, 0, 0}, {20, 3, 1}).away_mps, 3);
    EXPECT_EQ(sum_of({20, 3, 1}, {no_echo_dbz, 0, 0}).dbz, 20);
}

TEST(Jitter, IsBoundedSmoothAndOfItsCut) {
    double most = 0;
    for (int i = 0; i < 2000; ++i) {
        const Jitter here = jitter_at(5, 0, 1, i * 0.01);
        const Jitter next = jitter_at(5, 0, 1, i * 0.01 + 0.01);
        EXPECT_LE(std::abs(here.azimuth), 1);
        EXPECT_LE(std::abs(here.elevation), 1);
        // The fastest wave has a period of 1.7 s. The mean of the three waves changes by at most 2
        // pi (1/1.7 + ...) / 3 a second.
        EXPECT_LT(std::abs(next.azimuth - here.azimuth), 0.0225);
        most = std::max(most, std::abs(here.azimuth));
    }
    EXPECT_GT(most, 0.5);
    EXPECT_NE(jitter_at(5, 0, 1, 3).azimuth, jitter_at(5, 0, 2, 3).azimuth);
    EXPECT_NE(jitter_at(5, 0, 1, 3).azimuth, jitter_at(5, 1, 1, 3).azimuth);
    EXPECT_NE(jitter_at(5, 0, 1, 3).azimuth, jitter_at(5, 0, 1, 3).elevation);
}

TEST(Missing, SectorsRunClockwiseThroughNorth) {
    Instrument instrument;
    instrument.missing_radials = {{std::nullopt, 350, 4}, {2, 100, 100}, {3, -10, 350}};
    const auto missing = [&](int cut, double azimuth_deg) {
        return is_missing(instrument, {0, cut, 0, azimuth_deg});
    };
    EXPECT_TRUE(missing(1, 350));
    EXPECT_TRUE(missing(1, 0));
    EXPECT_TRUE(missing(1, 4));
    EXPECT_FALSE(missing(1, 4.5));
    EXPECT_FALSE(missing(1, 349.5));
    EXPECT_TRUE(missing(2, 100));
    EXPECT_FALSE(missing(1, 100));
    EXPECT_TRUE(missing(3, 180)) << "the sector is a full circle";
    instrument.missing_cuts = {4};
    EXPECT_TRUE(missing(4, 200));
}

TEST(Missing, AFractionIsLostAtRandom) {
    Instrument instrument;
    instrument.missing_fraction = 0.1;
    int lost = 0;
    for (int i = 0; i < 36000; ++i) {
        lost += is_missing(instrument, {i / 7200, 1 + i / 720 % 10, i % 720, 0}) ? 1 : 0;
    }
    EXPECT_NEAR(lost, 3600, 4 * std::sqrt(36000 * 0.1 * 0.9));
}

}  // namespace
}  // namespace stormcellar::synth

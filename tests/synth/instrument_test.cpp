// Tests the effects of the instrument in whole volumes that are written and read back.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/checksum.h"
#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "synth/observe.h"
#include "synth/synth_effects.h"
#include "tests/testing/data.h"

namespace stormcellar::synth {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::Sweep;
using level2::SweepMoment;

Scene scene_of(const char* name) {
    auto scene = read_scene(testing::source_directory() / "scenes" / name);
    if (!scene) throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

level2::Decoded written_and_read(const Scene& scene) {
    const auto encoded = level2::encode(observe(scene, 0));
    if (!encoded) throw std::runtime_error(encoded.error().message);
    auto decoded = level2::decode(encoded->joined());
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return std::move(*decoded);
}

std::uint64_t checksum_of(const SweepMoment& moment) {
    return xxh3_64(std::as_bytes(std::span(moment.codes8)));
}

// The expected codes are from 2026-11-20, before effects existed.
TEST(Instrument, WithoutEffectsTheCodesAreWhatTheyWere) {
    const level2::Volume volume = observe(scene_of("small-storm.toml"), 1);
    std::vector<std::uint64_t> sums;
    for (const Sweep& sweep : volume.sweeps) {
        for (const SweepMoment& moment : sweep.moments) {
            sums.push_back(checksum_of(moment));
        }
    }
    EXPECT_EQ(sums,
              (std::vector<std::uint64_t>{
                  0x3dda02d51c3a52ac, 0x138351af58dbee0b, 0xdba9d08cecd5287a, 0x303c4e2a1612f547,
                  0x74ed6f7be3b85641, 0xdf36cfcd8e5fcd61, 0xd21cfce46662357e}));
}

TEST(Instrument, VelocityFoldingWrapsOntoTheNyquistInterval) {
    Scene scene = scene_of("small-storm.toml");
    scene.weather.layers.clear();
    scene.weather.storms[0].footprint.motion = {40, 35};
    scene.instrument.velocity_folding = true;
    const level2::Decoded read = written_and_read(scene);
    const Sweep& sweep = read.volume.sweeps[1];
    const SweepMoment& vel = *sweep.find(Moment::vel);
    std::size_t folded = 0;
    for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
        const auto& radial = sweep.radials[row];
        const double azimuth = radial.azimuth_deg * degree;
        const double away_mps = (40 * std::sin(azimuth) + 35 * std::cos(azimuth)) *
                                std::cos(radial.elevation_deg * degree);
        const double nyquist = radial.nyquist_mps;
        for (std::int32_t gate = 0; gate < vel.gate_stride; ++gate) {
            if (vel.status(row, gate) != GateStatus::valid) continue;
            const double shown = vel.value_of(vel.code(row, gate));
            ASSERT_LE(std::abs(shown), nyquist + 0.2501);
            ASSERT_NEAR(std::remainder(shown - away_mps, 2 * nyquist), 0, 0.2501);
            folded += std::abs(away_mps) > nyquist ? 1U : 0U;
        }
    }
    EXPECT_GT(folded, 1000U);
}

// Two columns are in one direction. The far column is beyond 137 km, the range of PRF 6 of the
// Doppler cut.
TEST(Instrument, RangeFoldingMarksTheWeakerTripInDopplerCuts) {
    Scene scene = scene_of("small-storm.toml");
    Storm near = scene.weather.storms[0];
    near.tilt_east = near.tilt_north = 0;
    near.footprint.x_m = 0;
    near.footprint.y_m = 40000;
    Storm far = near;
    far.footprint.y_m = 40000 + 137000;
    far.core_m = 6000;
    scene.weather = {{near, far}, {}, {}};
    scene.instrument.range_folding = true;
    const level2::Decoded read = written_and_read(scene);
    const Sweep& doppler = read.volume.sweeps[1];
    const auto& vel = *doppler.find(Moment::vel);
    const auto& ref = *doppler.find(Moment::ref);
    const auto north_of = [](const Sweep& sweep) {
        std::size_t row = 0;
        while (std::abs(sweep.radials[row].azimuth_deg - 0.5F) > 0.01F)
            ++row;
        return row;
    };
    const std::size_t north = north_of(doppler);
    const Sweep& surveillance = read.volume.sweeps[0];
    const auto gate_at = [](double range_m) {
        return static_cast<std::int32_t>(std::lround((range_m - 2125) / 250));
    };
    // equally strong, but with 13 dB less power because of its distance
    EXPECT_EQ(vel.status(north, gate_at(177000)), GateStatus::range_folded);
    EXPECT_EQ(doppler.find(Moment::sw)->status(north, gate_at(177000)), GateStatus::range_folded);
    EXPECT_EQ(ref.status(north, gate_at(177000)), GateStatus::valid);
    EXPECT_EQ(vel.status(north, gate_at(40000)), GateStatus::valid);
    EXPECT_EQ(surveillance.find(Moment::ref)->status(north_of(surveillance), gate_at(177000)),
              GateStatus::valid);
    // Without the near storm, nothing folds.
    scene.weather.storms.erase(scene.weather.storms.begin());
    const level2::Decoded alone = written_and_read(scene);
    EXPECT_EQ(alone.volume.sweeps[1].find(Moment::vel)->status(north, gate_at(177000)),
              GateStatus::valid);
}

TEST(Instrument, LostRadialsAndCutsAreNotInTheVolume) {
    Scene scene = scene_of("small-storm.toml");
    scene.instrument.missing_radials = {{std::nullopt, 350, 10}};
    scene.instrument.missing_cuts = {2};
    const level2::Decoded read = written_and_read(scene);
    ASSERT_EQ(read.volume.sweeps.size(), 2U);
    EXPECT_EQ(read.volume.sweeps[1].elevation_number, 3);
    for (const Sweep& sweep : read.volume.sweeps) {
        EXPECT_EQ(sweep.radials.size(), 340U);  // the radials from 350.5 to 9.5 are lost
        for (const auto& radial : sweep.radials) {
            EXPECT_GT(radial.azimuth_deg, 10);
            EXPECT_LT(radial.azimuth_deg, 350);
        }
    }
    EXPECT_TRUE(level2::has_ended(read.volume));
    // The other radials are unchanged.
    Scene whole = scene;
    whole.instrument = {};
    const level2::Volume all = observe(whole, 0);
    const auto& lost_ref = *read.volume.sweeps[1].find(Moment::ref);
    const auto& ref = *all.sweeps[2].find(Moment::ref);
    std::size_t row = 0;
    for (std::size_t i = 0; i < all.sweeps[2].radials.size(); ++i) {
        const auto& radial = all.sweeps[2].radials[i];
        if (radial.azimuth_deg > 350 || radial.azimuth_deg < 10) continue;
        ASSERT_EQ(read.volume.sweeps[1].radials[row].time, radial.time);
        for (std::int32_t gate = 0; gate < ref.gate_stride; ++gate)
            ASSERT_EQ(lost_ref.code(row, gate), ref.code(i, gate));
        ++row;
    }
    scene.instrument.missing_cuts = {1, 2, 3};
    EXPECT_TRUE(observe(scene, 0).sweeps.empty());
}

TEST(Instrument, JitterIsSaidByTheRadialsAndTheirGatesAreTrueThere) {
    Scene scene = scene_of("small-storm.toml");
    scene.instrument.azimuth_jitter_deg = 0.2;
    scene.instrument.elevation_jitter_deg = 0.15;
    scene.instrument.noise_db = 1e-12;  // so that the code for effects runs
    const level2::Volume volume = observe(scene, 0);
    const grid::BeamGeometry beam(scene.site.latitude_deg, scene.site.antenna_altitude_m);
    double most_off_deg = 0;
    for (const Sweep& sweep : volume.sweeps) {
        const auto& ref = *sweep.find(Moment::ref);
        for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
            const auto& radial = sweep.radials[row];
            const double nominal = std::floor(radial.azimuth_deg) + 0.5;
            ASSERT_LT(std::abs(radial.azimuth_deg - nominal), 0.2001);
            const double off_deg = radial.elevation_deg - *sweep.vcp_elevation_deg;
            ASSERT_LT(std::abs(off_deg), 0.1501);
            most_off_deg = std::max(most_off_deg, std::abs(off_deg));
            const double t_s =
                std::chrono::duration<double>(radial.time - scene.schedule.start).count();
            for (std::int32_t gate = 0; gate < ref.gate_stride; gate += 7) {
                if (ref.status(row, gate) != GateStatus::valid) continue;
                const auto earth = beam.forward({ref.range_m(gate), radial.elevation_deg});
                const double azimuth = radial.azimuth_deg * degree;
                const Point point{earth.arc_m * std::sin(azimuth), earth.arc_m * std::cos(azimuth),
                                  earth.height_m};
                ASSERT_NEAR(ref.value_of(ref.code(row, gate)), truth_dbz(scene.weather, point, t_s),
                            0.2501);
            }
        }
    }
    EXPECT_GT(most_off_deg, 0.08);
}

TEST(Instrument, NoiseInVolumesHasItsDeviationAndIsOfItsSeed) {
    Scene scene = scene_of("small-storm.toml");
    scene.weather.storms.clear();
    Box box;
    box.footprint.major_m = box.footprint.minor_m = 50000;
    box.peak_dbz = 40;
    box.footprint.motion = {0, 10};
    scene.weather.boxes = {box};
    scene.weather.layers.clear();
    scene.instrument.noise_db = 1.5;
    scene.instrument.velocity_noise_mps = 2;
    const level2::Volume volume = observe(scene, 0);
    const auto& ref = *volume.sweeps[1].find(Moment::ref);
    const auto& vel = *volume.sweeps[1].find(Moment::vel);
    double db[3] = {};
    double mps[3] = {};
    for (std::size_t row = 0; row < 360; ++row) {
        const auto& radial = volume.sweeps[1].radials[row];
        const double away_mps =
            10 * std::cos(radial.azimuth_deg * degree) * std::cos(radial.elevation_deg * degree);
        for (std::int32_t gate = 0; gate < 150; ++gate) {
            const double z = ref.value_of(ref.code(row, gate)) - 40;
            const double v = vel.value_of(vel.code(row, gate)) - away_mps;
            db[0] += 1, db[1] += z, db[2] += z * z;
            mps[0] += 1, mps[1] += v, mps[2] += v * v;
        }
    }
    const double k = 1.5 * std::numbers::ln10 / 10;
    EXPECT_NEAR(db[1] / db[0], -10 / std::numbers::ln10 * k * k / 2, 0.03);
    // Rounding to half a decibel or half a meter a second adds 0.5^2 / 12 to the variance.
    EXPECT_NEAR(std::sqrt(db[2] / db[0] - std::pow(db[1] / db[0], 2) - 0.25 / 12), 1.5, 0.03);
    EXPECT_NEAR(mps[1] / mps[0], 0, 0.04);
    EXPECT_NEAR(std::sqrt(mps[2] / mps[0] - 0.25 / 12), 2, 0.04);
    EXPECT_EQ(checksum_of(*observe(scene, 0).sweeps[1].find(Moment::ref)), checksum_of(ref));
    scene.instrument.seed = 1;
    EXPECT_NE(checksum_of(*observe(scene, 0).sweeps[1].find(Moment::ref)), checksum_of(ref));
}

// Lost radials or other cuts do not change the random numbers of a gate.
TEST(Instrument, NoiseBelongsToTheGateWhateverElseIsObserved) {
    Scene scene = scene_of("small-storm.toml");
    scene.instrument.noise_db = 1;
    const level2::Volume all = observe(scene, 0);
    scene.instrument.missing_radials = {{std::nullopt, 0, 20}};
    scene.instrument.missing_cuts = {1};
    const level2::Volume some = observe(scene, 0);
    const Sweep& whole = all.sweeps[2];
    const Sweep& rest = some.sweeps[1];
    std::size_t row = 0;
    for (std::size_t i = 0; i < whole.radials.size(); ++i) {
        if (row == rest.radials.size() || whole.radials[i].time != rest.radials[row].time) continue;
        const auto& a = *whole.find(Moment::ref);
        const auto& b = *rest.find(Moment::ref);
        for (std::int32_t gate = 0; gate < a.gate_stride; ++gate)
            ASSERT_EQ(a.code(i, gate), b.code(row, gate));
        ++row;
    }
    EXPECT_EQ(row, 340U);
}

TEST(Instrument, ClutterStandsStillNearTheRadar) {
    Scene scene = scene_of("small-storm.toml");
    scene.weather = {};
    scene.instrument.clutter = Clutter{};
    const level2::Volume volume = observe(scene, 0);
    const auto& ref = *volume.sweeps[1].find(Moment::ref);
    const auto& vel = *volume.sweeps[1].find(Moment::vel);
    std::size_t valid = 0;
    for (std::size_t row = 0; row < 360; ++row) {
        for (std::int32_t gate = 0; gate < vel.gate_stride; ++gate) {
            if (ref.status(row, gate) != GateStatus::valid) continue;
            ++valid;
            ASSERT_LT(ref.range_m(gate), clutter_reach_m(Clutter{}));
            ASSERT_EQ(vel.value_of(vel.code(row, gate)), 0);
        }
    }
    EXPECT_GT(valid, 20000U);
    const auto& high = *volume.sweeps[2].find(Moment::ref);
    for (const auto code : high.codes8)
        ASSERT_EQ(code, 0) << "a sweep at 4 degrees has no clutter";
}

}  // namespace
}  // namespace stormcellar::synth

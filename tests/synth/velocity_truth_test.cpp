// Tests that a simulated radar observes the wind of its scene, and that the truth of every gate is
// right.
#include "synth/velocity_truth.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "synth/beam_quadrature.h"
#include "synth/observe.h"

namespace stormcellar::synth {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::Sweep;
using level2::SweepMoment;

// A wind with parts of every kind and rain everywhere in it, observed at 0.5 degrees.
constexpr const char* windy_toml = R"([radar]
station = "XSYN"
latitude_deg = 35
longitude_deg = -97
altitude_m = 400
[volumes]
count = 2
start = "2024-06-01T22:00:00Z"
interval_s = 60
[[cut]]
elevation_deg = 0.5
azimuth_rate_deg_s = 20
[[box]]
position_km = [0, 0]
radii_km = [90, 90]
top_km = 12
peak_dbz = 40
[[wind.level]]
velocity_mps = [5, 20]
[[wind.level]]
height_km = 3
velocity_mps = [30, 10]
[[wind.vortex]]
position_km = [45, 10]
velocity_mps = [15, 5]
radius_km = 6
tangential_mps = 35
[[wind.vortex]]
position_km = [-30, 20]
radius_km = 2
radial_mps = 12
[instrument]
velocity_folding = "on"
)";

Scene windy_scene(float nyquist_mps = 0) {
    auto scene = parse_scene(windy_toml, "windy.toml");
    if (!scene) throw std::runtime_error(scene.error().message);
    scene->schedule.pattern.cuts[0].nyquist_mps = nyquist_mps;
    return std::move(*scene);
}

// The wind along the beam at the center of a gate, in closed form.
double expected_mps(const Scene& scene, const level2::Radial& radial, double range_m) {
    const grid::BeamGeometry beam(scene.site.latitude_deg, scene.site.antenna_altitude_m);
    const auto earth = beam.forward({range_m, radial.elevation_deg});
    const Point point{earth.arc_m * std::sin(radial.azimuth_deg * degree),
                      earth.arc_m * std::cos(radial.azimuth_deg * degree), earth.height_m};
    const double t_s = std::chrono::duration<double>(radial.time - scene.schedule.start).count();
    return away_mps(wind_at(*scene.weather.wind, point, t_s), radial.azimuth_deg,
                    radial.elevation_deg);
}

struct Tally {
    std::size_t shown = 0, folded = 0, unknown = 0;
    double largest_error_mps = 0;
};
// Compares raw + 2 n nyquist with the truth at every gate that shows a velocity.
Tally tally(const Sweep& sweep, const VelocityTruth& truth) {
    const SweepMoment& vel = *sweep.find(Moment::vel);
    Tally tally;
    for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
        for (std::int32_t gate = 0; gate < vel.gate_stride; ++gate) {
            if (vel.status(row, gate) != GateStatus::valid) continue;
            const std::size_t at =
                row * static_cast<std::size_t>(vel.gate_stride) + static_cast<std::size_t>(gate);
            ++tally.shown;
            tally.folded += truth.folds[at] != 0 ? 1U : 0U;
            if (std::isnan(truth.away_mps[at])) ++tally.unknown;
            if (std::isnan(truth.away_mps[at])) continue;
            const double unfolded_mps =
                vel.value_of(vel.code(row, gate)) +
                2.0 * truth.folds[at] * static_cast<double>(sweep.radials[row].nyquist_mps);
            tally.largest_error_mps =
                std::max(tally.largest_error_mps, std::abs(unfolded_mps - truth.away_mps[at]));
        }
    }
    return tally;
}

// Half a code is 0.25 m/s.
TEST(VelocityTruth, UnfoldsEveryGateAtAnyNyquistVelocity) {
    for (const float nyquist_mps : {5.0F, 8.0F, 12.34F, 26.24F, 63.0F}) {
        const Scene scene = windy_scene(nyquist_mps);
        const level2::Volume volume = observe(scene, 1);
        const Sweep& sweep = volume.sweeps.at(0);
        EXPECT_EQ(sweep.radials[0].nyquist_mps, nyquist_mps);
        const Tally found = tally(sweep, velocity_truth(scene, sweep, VelocitySample::point));
        EXPECT_GT(found.shown, 120'000U);
        EXPECT_EQ(found.unknown, 0U);
        EXPECT_LE(found.largest_error_mps, 0.2501) << nyquist_mps;
        // No wind is as strong as 63 m/s.
        EXPECT_EQ(found.folded == 0, nyquist_mps == 63) << nyquist_mps;
        EXPECT_EQ(found.folded > found.shown / 5, nyquist_mps < 20) << nyquist_mps;
    }
}

TEST(VelocityTruth, IsTheWindAlongTheBeamAndTheFileHasIt) {
    const Scene scene = windy_scene(12.34F);
    const auto encoded = level2::encode(observe(scene, 1));
    ASSERT_TRUE(encoded) << encoded.error().message;
    const auto read = level2::decode(encoded->joined());
    ASSERT_TRUE(read) << read.error().message;
    const Sweep& sweep = read->volume.sweeps.at(0);
    const VelocityTruth truth = velocity_truth(scene, sweep, VelocitySample::point);
    const SweepMoment& vel = *sweep.find(Moment::vel);
    ASSERT_EQ(truth.away_mps.size(), vel.codes8.size());
    std::size_t compared = 0;
    for (std::size_t at = 0; at < truth.away_mps.size(); at += 7) {
        if (std::isnan(truth.away_mps[at])) continue;
        const auto stride = static_cast<std::size_t>(vel.gate_stride);
        const auto gate = static_cast<std::int32_t>(at % stride);
        ASSERT_NEAR(truth.away_mps[at],
                    expected_mps(scene, sweep.radials[at / stride], vel.range_m(gate)), 1e-9);
        ++compared;
    }
    EXPECT_GT(compared, 15'000U);
    EXPECT_LE(tally(sweep, truth).largest_error_mps, 0.2501);
}

TEST(VelocityTruth, WithNoiseTheFoldNumberIsTheSame) {
    Scene scene = windy_scene(8);
    scene.instrument.velocity_noise_mps = 1;
    const level2::Volume volume = observe(scene, 0);
    const Sweep& sweep = volume.sweeps.at(0);
    const VelocityTruth truth = velocity_truth(scene, sweep, VelocitySample::point);
    const SweepMoment& vel = *sweep.find(Moment::vel);
    double count = 0, sum = 0, squares = 0;
    for (std::size_t row = 0; row < 360; ++row) {
        for (std::int32_t gate = 0; gate < 300; ++gate) {
            const std::size_t at =
                row * static_cast<std::size_t>(vel.gate_stride) + static_cast<std::size_t>(gate);
            const double error_mps =
                vel.value_of(vel.code(row, gate)) + 16.0 * truth.folds[at] - truth.away_mps[at];
            ASSERT_LT(std::abs(error_mps), 7) << "noise has 6.8 deviations at most";
            count += 1, sum += error_mps, squares += error_mps * error_mps;
        }
    }
    EXPECT_NEAR(sum / count, 0, 0.01);
    EXPECT_NEAR(std::sqrt(squares / count - 0.25 / 12), 1, 0.01);
}

// Takes the mean over the pattern by brute force, 3 times as fine as the finest quadrature.
double fine_mps(const Scene& scene, const level2::Radial& radial, double range_m) {
    const grid::BeamGeometry beam(scene.site.latitude_deg, scene.site.antenna_altitude_m);
    const double width_deg = scene.instrument.beam_width_deg;
    const double t_s = std::chrono::duration<double>(radial.time - scene.schedule.start).count();
    const auto across = azimuth_nodes(width_deg, radial.elevation_deg, 1, 12);
    double weight = 0, sum = 0;
    for (const BeamNode& up : elevation_nodes(width_deg, 12)) {
        const double elevation_deg = radial.elevation_deg + up.offset;
        const auto earth = beam.forward({range_m, elevation_deg});
        for (const BeamNode& node : across) {
            const double azimuth_deg = radial.azimuth_deg + node.offset;
            const Point point{earth.arc_m * std::sin(azimuth_deg * degree),
                              earth.arc_m * std::cos(azimuth_deg * degree), earth.height_m};
            const double z =
                up.weight * node.weight * linear_truth(scene.weather, point, t_s).z_mm6_m3;
            weight += z;
            sum +=
                z * away_mps(wind_at(*scene.weather.wind, point, t_s), azimuth_deg, elevation_deg);
        }
    }
    return sum / weight;
}

struct BeamErrors {
    double of_quadrature_mps = 0;
    double of_point_mps = 0;
};
// Returns the largest errors at the gates near a place.
BeamErrors beam_errors(const Scene& scene, double x_m, double y_m) {
    const level2::Volume volume = observe(scene, 0);
    const Sweep& sweep = volume.sweeps.at(0);
    const SweepMoment& vel = *sweep.find(Moment::vel);
    const VelocityTruth mean = velocity_truth(scene, sweep, VelocitySample::gate);
    const VelocityTruth point = velocity_truth(scene, sweep, VelocitySample::point);
    EXPECT_LE(tally(sweep, mean).largest_error_mps, 0.2501);
    BeamErrors errors;
    for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
        const level2::Radial& radial = sweep.radials[row];
        for (std::int32_t gate = 0; gate < 700; ++gate) {
            const double range_m = vel.range_m(gate);
            const double off_m = std::hypot(range_m * std::sin(radial.azimuth_deg * degree) - x_m,
                                            range_m * std::cos(radial.azimuth_deg * degree) - y_m);
            if (off_m > 3000) continue;
            const std::size_t at =
                row * static_cast<std::size_t>(vel.gate_stride) + static_cast<std::size_t>(gate);
            const double fine = fine_mps(scene, radial, range_m);
            errors.of_quadrature_mps =
                std::max(errors.of_quadrature_mps, std::abs(mean.away_mps[at] - fine));
            errors.of_point_mps =
                std::max(errors.of_point_mps, std::abs(point.away_mps[at] - fine));
        }
    }
    return errors;
}

TEST(VelocityTruth, OfAGateIsTheMeanOverTheBeam) {
    Scene scene = windy_scene(20);
    scene.instrument.beam_width_deg = 0.95;
    // Rain around the vortex alone is enough for this test, and quick to observe.
    Footprint& footprint = scene.weather.boxes[0].footprint;
    footprint.x_m = 60000;
    footprint.y_m = 30000;
    footprint.major_m = footprint.minor_m = 6000;
    // The rain is smooth and reaches below the beam, so only the vortex asks for many points.
    scene.weather.boxes[0].edge_m = 5000;
    scene.weather.boxes[0].base_m = -2000;
    for (const double radius_m : {300.0, 1000.0, 3000.0}) {
        Vortex vortex;
        vortex.x_m = 60000;
        vortex.y_m = 30000;
        vortex.radius_m = radius_m;
        vortex.tangential_mps = 50;
        scene.weather.wind->vortices = {vortex};
        const BeamErrors errors = beam_errors(scene, 60000, 30000);
        EXPECT_LT(errors.of_quadrature_mps, 0.1) << radius_m;
        EXPECT_GT(errors.of_point_mps, 2) << "a beam smooths the vortex";
    }
    scene.weather.wind = Wind{{{1000, {0, 0}}, {1500, {10, 20}}, {2000, {0, 0}}}};
    const BeamErrors errors = beam_errors(scene, 60000, 30000);
    EXPECT_LT(errors.of_quadrature_mps, 0.1);
    EXPECT_GT(errors.of_point_mps, 2) << "a beam smooths the jet";
}

// Up to 1.4 km above sea level, rain of 50 dBZ moves with 10 m/s; above this height, rain of 20 dBZ
// moves with 40 m/s. The axis of the beam is just above 1.4 km, but the strong rain has 1000 times
// the weight.
TEST(VelocityTruth, StrongEchoOutweighsWeakEcho) {
    Scene scene = windy_scene(60);
    scene.instrument.beam_width_deg = 0.95;
    scene.weather.wind = Wind{{{1399, {0, 10}}, {1401, {0, 40}}}};
    Box strong = scene.weather.boxes[0];
    strong.footprint.y_m = 79000;
    strong.footprint.major_m = strong.footprint.minor_m = 6000;
    strong.top_m = 1400;
    strong.peak_dbz = 50;
    Box weak = strong;
    weak.base_m = 1400;
    weak.top_m = 12000;
    weak.peak_dbz = 20;
    scene.weather.boxes = {strong, weak};
    const level2::Volume volume = observe(scene, 0);
    const Sweep& sweep = volume.sweeps.at(0);
    const SweepMoment& vel = *sweep.find(Moment::vel);
    const auto north = std::find_if(sweep.radials.begin(), sweep.radials.end(),
                                    [](const auto& r) { return r.azimuth_deg == 0.5F; });
    ASSERT_NE(north, sweep.radials.end());
    const auto row = static_cast<std::size_t>(north - sweep.radials.begin());
    const VelocityTruth mean = velocity_truth(scene, sweep, VelocitySample::gate);
    const VelocityTruth point = velocity_truth(scene, sweep, VelocitySample::point);
    const std::size_t gate = 308;  // 79 km away, where the axis is 1.46 km high
    const std::size_t at = row * static_cast<std::size_t>(vel.gate_stride) + gate;
    EXPECT_NEAR(point.away_mps[at], 40, 0.01);
    EXPECT_LT(mean.away_mps[at], 10.2);
    EXPECT_GT(mean.away_mps[at], 10);
}

TEST(VelocityTruth, MissingGatesAndSpeckleHaveTheirSharesAndNoTruth) {
    Scene scene = windy_scene(12);
    const level2::Volume whole = observe(scene, 0);
    scene.instrument.missing_gate_fraction = 0.2;
    scene.instrument.speckle_fraction = 0.03;
    const level2::Volume volume = observe(scene, 0);
    const Sweep& sweep = volume.sweeps.at(0);
    const VelocityTruth truth = velocity_truth(scene, sweep, VelocitySample::point);
    const SweepMoment& before = *whole.sweeps.at(0).find(Moment::vel);
    const SweepMoment& after = *sweep.find(Moment::vel);
    double echo = 0, missing = 0, empty = 0, speckle = 0, sum = 0, squares = 0;
    for (std::size_t at = 0; at < after.codes8.size(); ++at) {
        if (before.codes8[at] != 0) {
            ++echo;
            missing += after.codes8[at] == 0 ? 1 : 0;
            ASSERT_TRUE(after.codes8[at] == 0 || after.codes8[at] == before.codes8[at]);
            continue;
        }
        ++empty;
        if (after.codes8[at] == 0) continue;
        ++speckle;
        ASSERT_TRUE(std::isnan(truth.away_mps[at]));
        const double shown_mps = after.value_of(after.codes8[at]);
        ASSERT_LE(std::abs(shown_mps), 12);
        sum += shown_mps;
        squares += shown_mps * shown_mps;
    }
    EXPECT_GT(echo, 120'000);
    EXPECT_NEAR(missing / echo, 0.2, 0.005);
    EXPECT_NEAR(speckle / empty, 0.8 * 0.03, 0.001) << "a fifth of the speckle is missing, too";
    EXPECT_NEAR(sum / speckle, 0, 0.3);
    EXPECT_NEAR(std::sqrt(squares / speckle), 12 / std::sqrt(3.0), 0.15);
    EXPECT_EQ(tally(sweep, truth).unknown, static_cast<std::size_t>(speckle));
    EXPECT_EQ(observe(scene, 0).sweeps.at(0).find(Moment::vel)->codes8, after.codes8);
    scene.instrument.seed = 1;
    EXPECT_NE(observe(scene, 0).sweeps.at(0).find(Moment::vel)->codes8, after.codes8);
}

TEST(VelocityTruth, WithoutAWindIsTheMotionOfTheFeatures) {
    Scene scene = windy_scene(12);
    scene.weather.wind.reset();
    scene.weather.boxes[0].footprint.motion = {0, 30};
    const level2::Volume volume = observe(scene, 0);
    const Sweep& sweep = volume.sweeps.at(0);
    const VelocityTruth truth = velocity_truth(scene, sweep, VelocitySample::gate);
    const level2::Radial& radial = sweep.radials[100];
    const auto stride = static_cast<std::size_t>(sweep.find(Moment::vel)->gate_stride);
    EXPECT_NEAR(truth.away_mps[100 * stride + 50],
                away_mps({0, 30}, radial.azimuth_deg, radial.elevation_deg), 1e-9);
    EXPECT_LE(tally(sweep, truth).largest_error_mps, 0.2501);
}

TEST(VelocityTruth, ASweepOfAnotherSceneHasNone) {
    const Scene scene = windy_scene();
    const level2::Volume volume = observe(scene, 0);
    Sweep sweep = volume.sweeps.at(0);
    for (const int cut : {-1, 0, 2}) {
        sweep.elevation_number = cut;
        EXPECT_TRUE(velocity_truth(scene, sweep, VelocitySample::gate).away_mps.empty()) << cut;
    }
    sweep.elevation_number = 1;
    sweep.moments.resize(1);  // only REF
    EXPECT_TRUE(velocity_truth(scene, sweep, VelocitySample::gate).folds.empty());
    EXPECT_TRUE(velocity_truth(scene, {}, VelocitySample::point).folds.empty());
    // A radial without a Nyquist velocity cannot be unfolded.
    sweep = volume.sweeps.at(0);
    sweep.radials[5].nyquist_mps = 0;
    const VelocityTruth truth = velocity_truth(scene, sweep, VelocitySample::point);
    const auto stride = static_cast<std::ptrdiff_t>(sweep.find(Moment::vel)->gate_stride);
    const auto first = truth.folds.begin() + 5 * stride;
    EXPECT_EQ(std::count(first, first + stride, 0), stride);
}

}  // namespace
}  // namespace stormcellar::synth

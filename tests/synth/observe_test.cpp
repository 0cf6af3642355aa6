// Reads back the volumes of a simulated radar and compares them with the truth.
#include "synth/observe.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "grid/beam/detection_limit.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "tests/testing/data.h"

namespace stormcellar::synth {
namespace {

using level2::GateStatus;
using level2::Moment;
using level2::Sweep;

Scene small_storm() {
    auto scene = read_scene(testing::source_directory() / "scenes/small-storm.toml");
    if (!scene) throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

// Writes a volume as the bytes of a file, and decodes these bytes.
level2::Decoded written_and_read(const Scene& scene, int number) {
    const auto encoded = level2::encode(observe(scene, number));
    if (!encoded) throw std::runtime_error(encoded.error().message);
    auto decoded = level2::decode(encoded->joined());
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return std::move(*decoded);
}

struct Sample {
    Point point;
    double t_s = 0;
    double sine = 0;
    double cosine = 0;
};

Sample sample_at(const Scene& scene, const level2::Radial& radial, double range_m) {
    const grid::BeamGeometry beam(scene.site.latitude_deg, scene.site.antenna_altitude_m);
    const auto earth = beam.forward({range_m, radial.elevation_deg});
    const double sine = std::sin(radial.azimuth_deg * degree);
    const double cosine = std::cos(radial.azimuth_deg * degree);
    const double t_s = std::chrono::duration<double>(radial.time - scene.schedule.start).count();
    return {{earth.arc_m * sine, earth.arc_m * cosine, earth.height_m}, t_s, sine, cosine};
}

TEST(Observe, IsACompleteVolumeOfItsSiteTimeAndPattern) {
    const Scene scene = small_storm();
    const level2::Decoded read = written_and_read(scene, 1);
    EXPECT_TRUE(read.report.complete);
    EXPECT_TRUE(read.report.problems.empty()) << read.report.problems.front().message;
    EXPECT_EQ(read.volume.station, "XSYN");
    EXPECT_EQ(read.volume.vcp, 767);
    EXPECT_EQ(read.volume.header->time(), scene.schedule.start_of(1));
    EXPECT_FLOAT_EQ(read.volume.block->latitude_deg, 35);
    EXPECT_FLOAT_EQ(read.volume.block->longitude_deg, -97);
    EXPECT_EQ(read.volume.block->site_height_m + read.volume.block->tower_height_m, 400);
    ASSERT_EQ(read.volume.sweeps.size(), 3U);
    EXPECT_EQ(read.volume.sweeps[0].find(Moment::vel), nullptr);
    EXPECT_NE(read.volume.sweeps[1].find(Moment::vel), nullptr);
    UtcTime last{};
    for (const Sweep& sweep : read.volume.sweeps) {
        EXPECT_EQ(sweep.radials.size(), 360U);
        for (const auto& radial : sweep.radials) {
            EXPECT_GT(radial.time, last);
            last = radial.time;
        }
    }
    EXPECT_LT(last, scene.schedule.start_of(2)) << "each volume ends before the next volume begins";
    EXPECT_EQ(volume_file_name(scene, 1), "XSYN20240601_220100_V06");
}

TEST(Observe, EveryGateOfReflectivityIsTheTruthToHalfACode) {
    const Scene scene = small_storm();
    const level2::Decoded read = written_and_read(scene, 0);
    std::size_t valid = 0;
    std::size_t weak = 0;
    for (const Sweep& sweep : read.volume.sweeps) {
        const auto& ref = *sweep.find(Moment::ref);
        for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
            const auto limit = grid::detection_limit(sweep.radials[row], ref, false);
            for (std::int32_t gate = 0; gate < ref.gate_stride; ++gate) {
                const Sample at = sample_at(scene, sweep.radials[row], ref.range_m(gate));
                const double truth = truth_dbz(scene.weather, at.point, at.t_s);
                const double limit_dbz = limit.at(ref.range_m(gate));
                if (ref.status(row, gate) == GateStatus::valid) {
                    ++valid;
                    ASSERT_NEAR(ref.value_of(ref.code(row, gate)), truth, 0.2501)
                        << "radial " << row << " gate " << gate;
                    ASSERT_GE(truth, limit_dbz - 1e-6);
                } else {
                    ASSERT_EQ(ref.status(row, gate), GateStatus::below_threshold);
                    ASSERT_LT(truth, limit_dbz + 1e-6) << "radial " << row << " gate " << gate;
                    weak += truth > weakest_dbz ? 1U : 0U;
                }
            }
        }
    }
    EXPECT_GT(valid, 20000U);
    EXPECT_GT(weak, 100U) << "echo below the limit of detection is not shown";
}

TEST(Observe, VelocityIsTheRadialPartOfTheMotionPositiveAway) {
    Scene scene = small_storm();
    scene.weather.layers.clear();
    const level2::Decoded read = written_and_read(scene, 0);
    std::size_t valid = 0;
    for (const Sweep& sweep : read.volume.sweeps) {
        const auto* vel = sweep.find(Moment::vel);
        if (vel == nullptr) continue;
        const auto& sw = *sweep.find(Moment::sw);
        for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
            const auto& radial = sweep.radials[row];
            for (std::int32_t gate = 0; gate < vel->gate_stride; ++gate) {
                if (vel->status(row, gate) != GateStatus::valid) continue;
                ++valid;
                const Sample at = sample_at(scene, radial, vel->range_m(gate));
                const double away_mps =
                    (15 * at.sine + 10 * at.cosine) * std::cos(radial.elevation_deg * degree);
                ASSERT_NEAR(vel->value_of(vel->code(row, gate)), away_mps, 0.2501);
                ASSERT_EQ(sw.value_of(sw.code(row, gate)), spectrum_width_mps);
            }
        }
    }
    EXPECT_GT(valid, 1000U);
    // The storm is southwest of the radar and moves northeast, toward the radar.
    const auto& vel = *read.volume.sweeps[1].find(Moment::vel);
    const auto& radials = read.volume.sweeps[1].radials;
    const auto south_west = std::find_if(radials.begin(), radials.end(), [](const auto& radial) {
        return radial.azimuth_deg == 217.5F;
    });
    ASSERT_NE(south_west, radials.end());
    const auto row = static_cast<std::size_t>(south_west - radials.begin());
    // Gate 191 is 49.9 km away.
    ASSERT_EQ(vel.status(row, 191), GateStatus::valid);
    EXPECT_LT(vel.value_of(vel.code(row, 191)), -15);
}

// Returns the centroid of a sweep's reflectivity in mm^6/m^3, with each gate weighted by its area.
Point centroid(const Scene& scene, const Sweep& sweep) {
    const auto& ref = *sweep.find(Moment::ref);
    double weight = 0;
    Point sum;
    for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
        for (std::int32_t gate = 0; gate < ref.gate_stride; ++gate) {
            if (ref.status(row, gate) != GateStatus::valid) continue;
            const Sample at = sample_at(scene, sweep.radials[row], ref.range_m(gate));
            const double z =
                std::pow(10, ref.value_of(ref.code(row, gate)) / 10) * ref.range_m(gate);
            weight += z;
            sum.x_m += z * at.point.x_m;
            sum.y_m += z * at.point.y_m;
        }
    }
    return {sum.x_m / weight, sum.y_m / weight, 0};
}

TEST(Observe, StormsMoveFromVolumeToVolume) {
    Scene scene = small_storm();
    scene.weather.layers.clear();
    scene.weather.storms[0].tilt_east = scene.weather.storms[0].tilt_north = 0;
    const Point before = centroid(scene, observe(scene, 0).sweeps[0]);
    const Point after = centroid(scene, observe(scene, 1).sweeps[0]);
    EXPECT_NEAR(after.x_m - before.x_m, 15 * 60, 30);
    EXPECT_NEAR(after.y_m - before.y_m, 10 * 60, 30);
    // The antenna reaches the storm, at azimuth 217, some 7 s after the start of the sweep.
    EXPECT_NEAR(before.x_m, -30000 + 15 * 7.2, 100);
    EXPECT_NEAR(before.y_m, -40000 + 10 * 7.2, 100);
}

TEST(Observe, NoWeatherIsAVolumeWithoutEcho) {
    Scene scene = small_storm();
    scene.weather = {};
    const level2::Decoded read = written_and_read(scene, 0);
    EXPECT_TRUE(read.report.complete);
    for (const Sweep& sweep : read.volume.sweeps) {
        for (const auto& moment : sweep.moments) {
            for (const auto code : moment.codes8)
                ASSERT_EQ(code, 0);
        }
    }
}

}  // namespace
}  // namespace stormcellar::synth

// Tests the beam width: the quadrature against closed forms and against a finer quadrature.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "synth/beam_quadrature.h"
#include "synth/radial_observer.h"
#include "tests/testing/data.h"

namespace stormcellar::synth {
namespace {

constexpr double width_deg = 0.95;

template <typename Value>
double mean_of(const std::vector<BeamNode>& nodes, Value value) {
    double sum = 0;
    for (const BeamNode& node : nodes) {
        sum += node.weight * value(node.offset);
    }
    return sum;
}

TEST(BeamQuadrature, HalfPowerEachWayIsAQuarter) {
    const double deviation_deg = pattern_deviation_deg(width_deg);
    const double half = width_deg / 2 / deviation_deg;
    EXPECT_NEAR(std::exp(-half * half / 2), 0.25, 1e-12);
}

TEST(BeamQuadrature, HasTheMomentsOfThePattern) {
    const double deviation_deg = pattern_deviation_deg(width_deg);
    for (const double points : {0.75, 1.5, 3.0}) {
        const auto up = elevation_nodes(width_deg, points);
        EXPECT_NEAR(mean_of(up, [](double) { return 1; }), 1, 1e-12);
        EXPECT_NEAR(mean_of(up, [](double x) { return x; }), 0, 1e-12);
        EXPECT_NEAR(std::sqrt(mean_of(up, [](double x) { return x * x; })), deviation_deg,
                    0.003 * deviation_deg);
        // The variance is the variance of the Gaussian plus 1/12 for the turn of one degree.
        for (const double elevation_deg : {0.5, 19.5, 60.0}) {
            const double own_deg = deviation_deg / std::cos(elevation_deg * degree);
            const auto across = azimuth_nodes(width_deg, elevation_deg, 1, points);
            EXPECT_NEAR(std::sqrt(mean_of(across, [](double x) { return x * x; })),
                        std::hypot(own_deg, 1 / std::sqrt(12)), 0.005 * own_deg);
        }
    }
    EXPECT_EQ(elevation_nodes(0, 3).size(), 1U);
    const auto along = range_nodes(470);
    EXPECT_NEAR(std::sqrt(mean_of(along, [](double x) { return x * x; })), 0.35 * 235, 1e-9);
    EXPECT_NEAR(mean_of(along, [](double) { return 1; }), 1, 1e-12);
}

// The first sweep of a volume with one feature, seen by a beam.
struct Observed {
    Scene scene;
    Cut cut;
    grid::BeamGeometry beam{35, 400};
    level2::Radial radial;

    Observed() {
        scene.site = {"XSYN", 35, -97, 400};
        cut.elevation_deg = nearest_elevation_deg(1.5);
        cut.waveform = Waveform::batch;
        cut.doppler_prf = 6;
        cut.azimuth_spacing_deg = 1;
        radial.elevation_deg = cut.elevation_deg;
        scene.instrument.beam_width_deg = width_deg;
    }
    std::vector<level2::SweepMoment> at(double azimuth_deg) {
        radial.azimuth_deg = static_cast<float>(azimuth_deg);
        RadialObserver observer(scene, beam, cut, radial, {0, 1, 1});
        observer.observe(0, 0, radial, 0);
        return observer.take();
    }
};

// The storm is independent of height. Its dBZ falls with the square of the distance across the
// beam, so Z is a Gaussian of deviation s. Its mean over a Gaussian beam of deviation b is known:
//   peak + 10 log10(s / sqrt(s^2 + b^2)) - (10 / ln 10) x^2 / (2 (s^2 + b^2)).
// The turn in azimuth is small. The tolerance of 0.1 is for the curvature of the arc across the
// beam, and for the end of the pattern.
TEST(BeamWidth, AGaussianStormIsSmearedAsItMustBe) {
    Observed observed;
    observed.cut.azimuth_spacing_deg = 0.01F;
    for (const double range_m : {40000.0, 100000.0, 180000.0}) {
        for (const double radius_m : {2500.0, 6000.0}) {
            Storm storm;
            storm.footprint.y_m = range_m;
            storm.footprint.minor_m = radius_m;  // east and west
            storm.footprint.major_m = 60000;     // along the beam: flat
            storm.core_m = 25000;                // independent of height below
            storm.top_m = 30000;
            storm.peak_dbz = 50;
            observed.scene.weather.storms = {storm};
            const auto gate = static_cast<std::int32_t>(std::lround((range_m - 2125) / 250));
            const double arc_m =
                observed.beam.forward({2125 + 250.0 * gate, observed.cut.elevation_deg}).arc_m;
            const double s = radius_m / std::sqrt(2 * std::numbers::ln10 / 10 * 40);
            const double b = arc_m * pattern_deviation_deg(width_deg) * degree /
                             std::cos(observed.cut.elevation_deg * degree);
            for (const double off_deg : {0.0, 0.5, 1.0}) {
                const auto moments = observed.at(off_deg);
                const double x = arc_m * std::sin(off_deg * degree);
                const double expected = 50 + 10 * std::log10(s / std::hypot(s, b)) -
                                        10 / std::numbers::ln10 * x * x / (2 * (s * s + b * b));
                if (expected < 5) continue;
                EXPECT_NEAR(moments[0].value_of(moments[0].code(0, gate)), expected, 0.25 + 0.1)
                    << range_m << " " << radius_m << " " << off_deg;
            }
        }
    }
}

// The radar looks north at a wide plateau that drifts east with V, so v = V sin(azimuth). To the
// north, the mean is therefore 0. The deviation is V times the deviation of the azimuth pattern,
// which includes the turn of the antenna.
TEST(BeamWidth, TheSpreadOfVelocityWidensTheSpectrum) {
    Observed observed;
    Box box;
    box.footprint.major_m = box.footprint.minor_m = 200000;
    box.top_m = 30000;
    box.footprint.motion = {150, 0};
    observed.scene.weather.boxes = {box};
    const auto moments = observed.at(0);
    const double b =
        pattern_deviation_deg(width_deg) * degree / std::cos(observed.cut.elevation_deg * degree);
    const double spread_mps = 150 * std::hypot(b, degree / std::sqrt(12));
    for (std::int32_t gate = 100; gate < 400; gate += 50) {
        EXPECT_NEAR(moments[0].value_of(moments[0].code(0, gate)), box.peak_dbz, 0.2501);
        EXPECT_NEAR(moments[1].value_of(moments[1].code(0, gate)), 0, 0.2501);
        EXPECT_NEAR(moments[2].value_of(moments[2].code(0, gate)), std::hypot(2, spread_mps), 0.26);
    }
}

// Returns the mean of linear Z over the pattern by brute force, 3 times as fine as the finest
// quadrature.
double fine_dbz(const Observed& observed, double azimuth_deg, double range_m) {
    const double elevation_deg = observed.cut.elevation_deg;
    const auto up = elevation_nodes(width_deg, 12);
    const auto across = azimuth_nodes(width_deg, elevation_deg, 1, 12);
    double z = 0;
    for (const BeamNode& a : up) {
        const auto earth = observed.beam.forward({range_m, elevation_deg + a.offset});
        for (const BeamNode& b : across) {
            const double azimuth = (azimuth_deg + b.offset) * degree;
            const Point point{earth.arc_m * std::sin(azimuth), earth.arc_m * std::cos(azimuth),
                              earth.height_m};
            z += a.weight * b.weight * linear_truth(observed.scene.weather, point, 0).z_mm6_m3;
        }
    }
    return 10 * std::log10(z);
}

struct Convergence {
    std::size_t count = 0;
    double percentile_99_db = 0;
    double largest_db = 0;
};

// Returns how far gates from 5 dBZ on differ from the fine quadrature, beyond the rounding of half
// a code.
Convergence convergence_of(const char* scene, std::int32_t gates_apart) {
    constexpr double elevation_deg = 1.5;
    Observed observed;
    auto read = read_scene(testing::source_directory() / "scenes" / scene);
    if (!read) throw std::runtime_error(read.error().message);
    observed.scene.weather = read->weather;
    observed.cut.elevation_deg = nearest_elevation_deg(elevation_deg);
    observed.radial.elevation_deg = observed.cut.elevation_deg;
    std::vector<double> errors;
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 30) {
        const auto moments = observed.at(azimuth_deg);
        const auto& ref = moments[0];
        for (std::int32_t gate = 6; gate < ref.gate_stride; gate += gates_apart) {
            const double dbz = ref.value_of(ref.code(0, gate));
            if (ref.status(0, gate) != level2::GateStatus::valid || dbz < 5) continue;
            const double fine = fine_dbz(observed, azimuth_deg, ref.range_m(gate));
            errors.push_back(std::max(0.0, std::abs(dbz - fine) - 0.25));
        }
    }
    std::sort(errors.begin(), errors.end());
    if (errors.empty()) return {};
    return {errors.size(), errors[errors.size() * 99 / 100], errors.back()};
}

TEST(BeamWidth, ConvergesInStormsToATenthOfADecibel) {
    for (const char* scene : {"truth-point.toml", "truth-supercell.toml"}) {
        const Convergence found = convergence_of(scene, 3);
        EXPECT_GT(found.count, 100U) << scene;
        EXPECT_LT(found.percentile_99_db, 0.1) << scene;
        EXPECT_LT(found.largest_db, 0.3) << scene;
    }
}

TEST(BeamWidth, ConvergesWhereWeatherIsCutOff) {
    const Convergence rain = convergence_of("truth-stratiform.toml", 29);
    EXPECT_GT(rain.count, 200U);
    EXPECT_LT(rain.percentile_99_db, 0.3);
    EXPECT_LT(rain.largest_db, 1);
    const Convergence wave = convergence_of("truth-sine.toml", 19);
    EXPECT_GT(wave.count, 200U);
    EXPECT_LT(wave.percentile_99_db, 0.3);
    EXPECT_LT(wave.largest_db, 2);
    const Convergence edge = convergence_of("truth-edge.toml", 11);
    EXPECT_GT(edge.count, 100U);
    EXPECT_LT(edge.largest_db, 2);
}

}  // namespace
}  // namespace stormcellar::synth

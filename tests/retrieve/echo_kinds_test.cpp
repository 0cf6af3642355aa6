// Tests the kinds that are named for echo that is not weather: on simulated volumes whose echo is
// of one kind, and on real volumes whose kinds are known from pictures.
#include "stormcellar/retrieve/echo_kinds.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "retrieve/quality/gate_field.h"
#include "stormcellar/level2/chunk_directory.h"
#include "tests/retrieve/echo_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

// Noise of one kind of echo.
class Noise {
  public:
    float operator()(double mean, double spread) {
        return static_cast<float>(mean + spread * normal_(random_));
    }
    bool chance(double share) { return uniform_(random_) < share; }

  private:
    std::mt19937 random_{11};
    std::normal_distribution<double> normal_;
    std::uniform_real_distribution<double> uniform_;
};

double wind_at(const EchoPlace& place, double speed_mps) {
    return speed_mps * std::cos(place.azimuth_deg * degree);
}

// Names all echo of a volume, as if the rule took no echo for weather.
EchoShares shares_of(const level2::Volume& volume) {
    std::vector<SweepQuality> qualities;
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
        const GateField field = gate_field(volume.sweeps[sweep], volume.sweeps[sweep].moments[0]);
        SweepQuality& quality = qualities.emplace_back(SweepQuality{sweep, 0, {}});
        for (const std::uint16_t code : field.codes)
            quality.probabilities.push_back(code != 0 ? 0.1F : std::nanf(""));
    }
    return echo_shares(echo_kinds(volume, qualities));
}

double share_of_names(const EchoShares& shares) {
    return 1 - shares.share(EchoKind::weather) - shares.share(EchoKind::other);
}

EchoGate clutter_gate(Noise& noise) {
    return {noise(20, 8), noise(0, 0.3), noise(0.7, 0.2)};
}

TEST(EchoKinds, FindsGroundClutter) {
    Noise noise;
    const auto shares = shares_of(echo_volume({}, [&](const EchoPlace& place) -> EchoGate {
        const bool is_ground = place.range_m < 50e3 && place.elevation_deg < 2 && noise.chance(0.6);
        return is_ground ? clutter_gate(noise) : EchoGate{};
    }));
    EXPECT_GE(shares.share(EchoKind::ground_clutter), 0.9);
    EXPECT_LE(shares.share(EchoKind::other), 0.1);
}

TEST(EchoKinds, FindsDistantGroundUnlessItIsSeenAbove) {
    for (const bool is_above : {false, true}) {
        Noise noise;
        const auto shares = shares_of(echo_volume({}, [&](const EchoPlace& place) -> EchoGate {
            const bool is_ground = place.range_m > 80e3 && place.range_m < 150e3 &&
                                   place.elevation_deg < (is_above ? 2 : 1);
            return is_ground ? clutter_gate(noise) : EchoGate{};
        }));
        if (is_above)
            EXPECT_LE(shares.share(EchoKind::distant_ground), 0.6);  // the upper sweep's
        else
            EXPECT_GE(shares.share(EchoKind::distant_ground), 0.9);
        EXPECT_EQ(shares.share(EchoKind::ground_clutter), 0);
    }
}

TEST(EchoKinds, FindsTheSunAndInterference) {
    Noise noise;
    EchoVolumeSpec spec;
    spec.elevations_deg = {0.5, 14};
    const auto shares = shares_of(echo_volume(spec, [&](const EchoPlace& place) -> EchoGate {
        // The sun is at 279.5 degrees, 14.1 degrees high.
        const bool is_sun = place.elevation_deg > 10 && std::abs(place.azimuth_deg - 279.5) < 1;
        const bool is_spoke = place.elevation_deg < 1 && std::abs(place.azimuth_deg - 40) < 1;
        if (is_sun) return {noise(-35 + 20 * std::log10(place.range_m / 1000), 1)};
        return is_spoke ? EchoGate{noise(10, 4)} : EchoGate{};
    }));
    EXPECT_NEAR(shares.share(EchoKind::sun_spike), 0.5, 0.05);
    EXPECT_NEAR(shares.share(EchoKind::interference), 0.5, 0.05);
}

EchoGate bird_gate(const EchoPlace& place, Noise& noise) {
    if (place.height_m > 2500 || place.range_m > 90e3) return {};
    return {noise(15, 2), noise(wind_at(place, 12), 1.5), noise(4, 0.5), noise(0.6, 0.1),
            noise(60, 25)};
}

TEST(EchoKinds, FindsBirdsAndInsectsWithAndWithoutDualPolarization) {
    for (const bool has_dual : {false, true}) {
        Noise noise;
        EchoVolumeSpec spec;
        spec.has_dual = has_dual;
        const auto shares = shares_of(
            echo_volume(spec, [&](const EchoPlace& place) { return bird_gate(place, noise); }));
        EXPECT_GE(shares.share(EchoKind::birds_and_insects), 0.9) << has_dual;
        EXPECT_LE(shares.share(EchoKind::ground_clutter), 0.001);
    }
}

// A volume that does not reach 3 km cannot show that the echo ends below.
TEST(EchoKinds, ClaimsNothingThatTheDataDoNotShow) {
    Noise noise;
    EchoVolumeSpec low;
    low.elevations_deg = {0.5, 1.5};
    const auto birds = shares_of(
        echo_volume(low, [&](const EchoPlace& place) { return bird_gate(place, noise); }));
    EXPECT_EQ(birds.share(EchoKind::other), 1);
    // Clutter without a velocity.
    const auto clutter = shares_of(echo_volume({}, [&](const EchoPlace& place) -> EchoGate {
        if (place.range_m > 50e3 || place.elevation_deg > 1) return {};
        return {noise(20, 8)};
    }));
    EXPECT_EQ(clutter.share(EchoKind::other), 1);
    // Drizzle all around the radar has a narrow spectrum.
    const auto drizzle = shares_of(echo_volume({}, [&](const EchoPlace& place) -> EchoGate {
        if (place.height_m > 2000) return {};
        return {noise(8, 1.5), noise(wind_at(place, 12), 0.7), noise(1, 0.2)};
    }));
    EXPECT_GE(drizzle.share(EchoKind::other), 0.99);
}

// The test treats each gate as not weather; even then, no gate may get a name.
TEST(EchoKinds, DoesNotNameRainOrHail) {
    for (const bool has_dual : {false, true}) {
        Noise noise;
        EchoVolumeSpec spec;
        spec.has_dual = has_dual;
        const auto rain = shares_of(echo_volume(spec, [&](const EchoPlace& place) -> EchoGate {
            if (place.height_m > 9000) return {};
            return {noise(25, 1.5), noise(wind_at(place, 15), 0.8), noise(1.5, 0.3),
                    noise(0.985, 0.01), noise(60, 3)};
        }));
        EXPECT_LE(share_of_names(rain), 0.01) << has_dual;
        const auto hail = shares_of(echo_volume(spec, [&](const EchoPlace& place) -> EchoGate {
            const bool is_core =
                std::abs(place.range_m - 40e3) < 8e3 && std::abs(place.azimuth_deg - 200) < 12;
            if (!is_core) return {};
            return {noise(60, 3), noise(wind_at(place, 20), 1.5), noise(4, 0.5), noise(0.86, 0.04),
                    noise(80, 12)};
        }));
        EXPECT_LE(share_of_names(hail), 0.01) << has_dual;
    }
}

TEST(EchoKinds, LeavesWeatherAndUnknownGatesAlone) {
    const level2::Volume volume =
        echo_volume({{0.5}, 12, 4, 1000, false}, [](const EchoPlace&) { return EchoGate{20}; });
    std::vector<float> probabilities(48, 0.4F);
    probabilities[0] = 0.5F;
    probabilities[1] = std::nanf("");
    const std::vector<SweepQuality> qualities = {{0, 0, probabilities}};
    const auto half = echo_kinds(volume, qualities);
    ASSERT_EQ(half.size(), 1U);
    EXPECT_EQ(half[0].kinds[0], EchoKind::weather);
    EXPECT_EQ(half[0].kinds[1], EchoKind::none);
    EXPECT_EQ(half[0].kinds[2], EchoKind::other);
    EXPECT_EQ(echo_kinds(volume, qualities, 0.4)[0].kinds[2], EchoKind::weather);
    EXPECT_EQ(echo_shares(half).gates, 47);
    EXPECT_TRUE(echo_kinds({}, {}).empty());
    EXPECT_EQ(echo_shares({}).share(EchoKind::other), 0);
    EXPECT_EQ(echo_kind_name(EchoKind::birds_and_insects), "birds and insects");
}

level2::Volume real_volume(const std::string& name) {
    auto decoded = level2::decode_path(testing::real_file(name));
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return std::move(decoded->volume);
}

EchoShares real_shares(const std::string& name) {
    const level2::Volume volume = real_volume(name);
    return echo_shares(echo_kinds(volume, weather_probabilities(volume)));
}

// The picture of KABR, on a clear winter evening, shows single gates of up to 25 dBZ within 60 km.
// Most of these gates stand still.
TEST(EchoKindsOfRealVolumes, HaveGroundClutterAtKabr) {
    STORMCELLAR_NEED_DATA();
    const EchoShares shares = real_shares("volumes/KABR20050101_000745.gz");
    EXPECT_GE(shares.share(EchoKind::ground_clutter), 0.3);
    EXPECT_EQ(shares.share(EchoKind::birds_and_insects), 0);
    EXPECT_EQ(shares.share(EchoKind::sun_spike), 0);
}

// The picture of KOKX shows a disk of 10 to 25 dBZ with a radius of 120 km. The disk comes from the
// north at 15 m/s, and no echo has the shape of a storm. There is no dual polarization.
TEST(EchoKindsOfRealVolumes, HaveBirdsAtKokx) {
    STORMCELLAR_NEED_DATA();
    const EchoShares shares = real_shares("mosaic-northeast/KOKX20100911_011047_V03.gz");
    EXPECT_GE(shares.share(EchoKind::birds_and_insects), 0.5);
    EXPECT_LE(shares.share(EchoKind::other), 0.15);
}

// The picture of KLOT shows a smooth disk of 10 to 25 dBZ within 110 km, between areas of rain with
// a correlation of 1. The disk has a correlation of 0.3 to 0.8 and comes from the north.
TEST(EchoKindsOfRealVolumes, HaveBirdsAtKlot) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("chunks/KLOT_34");
    const auto kinds = echo_kinds(volume, weather_probabilities(volume));
    const level2::Sweep& sweep = volume.sweeps.at(kinds.at(0).sweep);
    const level2::SweepMoment& ref = sweep.moments[kinds[0].moment];
    std::int64_t echo = 0, birds = 0;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
        for (std::int32_t gate = 0; ref.range_m(gate) < 80e3; ++gate) {
            if (ref.range_m(gate) < 20e3) continue;
            const auto kind = kinds[0].kinds[radial * static_cast<std::size_t>(ref.gate_stride) +
                                             static_cast<std::size_t>(gate)];
            echo += kind != EchoKind::none ? 1 : 0;
            birds += kind == EchoKind::birds_and_insects ? 1 : 0;
        }
    EXPECT_GE(static_cast<double>(birds), 0.7 * static_cast<double>(echo));
}

// Returns the share of certain weather, gates of at least 20 dBZ with a correlation of at least
// 0.97, that gets a name.
double named_weather(const level2::Volume& volume, bool only_single) {
    std::int64_t weather = 0, named = 0;
    for (const SweepKinds& of :
         echo_kinds(volume, weather_probabilities(volume, only_single), 0.5, only_single)) {
        const level2::Sweep& sweep = volume.sweeps[of.sweep];
        const level2::SweepMoment* rho = sweep.find(Moment::rho);
        if (rho == nullptr) continue;
        const GateField ref = gate_field(sweep, sweep.moments[of.moment]);
        const GateField correlation = gate_field(sweep, *rho);
        for (std::size_t radial = 0; radial < ref.radials; ++radial)
            for (std::size_t gate = 0; gate < std::min(ref.gates, correlation.gates); ++gate) {
                const bool is_weather =
                    ref.value(radial, gate) >= 20 && correlation.value(radial, gate) >= 0.97F;
                if (!is_weather) continue;
                const EchoKind kind = of.kinds[radial * ref.gates + gate];
                ++weather;
                named += kind != EchoKind::weather && kind != EchoKind::other ? 1 : 0;
            }
    }
    EXPECT_GT(weather, 5000);
    return static_cast<double>(named) / static_cast<double>(weather);
}

// Rain, snow, a hurricane and storms.
TEST(EchoKindsOfRealVolumes, HardlyNameCertainWeather) {
    STORMCELLAR_NEED_DATA();
    for (const char* name :
         {"volumes/KCRP20170826_044114.trimmed.ar2v", "volumes/KDMX20220305_232324.trimmed.ar2v",
          "volumes/KLBB20160601_150025_V06", "chunks/KLOT_34", "chunks/L2D_230"}) {
        const level2::Volume volume = real_volume(name);
        EXPECT_LE(named_weather(volume, false), 0.004) << name;
        EXPECT_LE(named_weather(volume, true), 0.002) << name;
    }
}

}  // namespace
}  // namespace stormcellar::retrieve

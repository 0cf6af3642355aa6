// Tests the melting layer on layers whose heights are known, and on real volumes.
#include "stormcellar/retrieve/melting_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/level2/decode.h"
#include "tests/retrieve/layered_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

level2::Volume volume_with(const MeltingProfile& profile, const LayeredSpec& spec) {
    return layered_volume(spec, [&](double, double, double height_m) {
        return height_m < 9000 ? profile.at(height_m) : DualPoint{};
    });
}

struct LayerCase {
    MeltingProfile profile;
    LayeredSpec spec;
};

// Layers of all shapes, as seen by three scan strategies.
std::vector<LayerCase> layer_cases() {
    std::mt19937 random(48);
    const auto between = [&](double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random);
    };
    const std::vector<std::vector<double>> strategies = {
        {4, 5.1, 6.4, 8, 10}, {4.3, 6, 9.9}, {4.5}};
    std::vector<LayerCase> made;
    for (unsigned i = 0; i < 24; ++i) {
        LayerCase one;
        one.profile.top_m = between(1200, 5200);
        one.profile.bottom_m = one.profile.top_m - between(300, 800);
        one.profile.depth = between(0.03, 0.1);
        one.profile.rain_dbz = between(20, 32);
        one.profile.bright_db = between(4, 9);
        one.profile.zdr_db = between(0.6, 1.6);
        one.profile.sharpness = between(1.5, 3.5);
        one.profile.low_place = between(0.45, 0.7);
        one.spec.elevations_deg = strategies[i % strategies.size()];
        one.spec.seed = i;
        one.spec.radials = 120;
        made.push_back(one);
    }
    return made;
}

// Errors of heights. Counts how many are within the stated error, and how many are within twice the
// stated error.
struct HeightScore {
    std::vector<double> errors;
    int within = 0, within_twice = 0;

    void add(double height_m, double truth_m, double stated_m) {
        errors.push_back(height_m - truth_m);
        within += std::abs(errors.back()) <= stated_m ? 1 : 0;
        within_twice += std::abs(errors.back()) <= 2 * stated_m ? 1 : 0;
    }
    [[nodiscard]] double rms() const {
        double sum = 0;
        for (const double error : errors)
            sum += error * error;
        return std::sqrt(sum / static_cast<double>(errors.size()));
    }
    [[nodiscard]] double largest() const {
        double most = 0;
        for (const double error : errors)
            most = std::max(most, std::abs(error));
        return most;
    }
    [[nodiscard]] double share(int count) const {
        return static_cast<double>(count) / static_cast<double>(errors.size());
    }
};

TEST(MeltingLayer, FindsSyntheticLayers) {
    HeightScore bottom, top;
    for (const LayerCase& one : layer_cases()) {
        const auto layer = melting_layer(volume_with(one.profile, one.spec));
        ASSERT_TRUE(layer) << one.spec.seed << ": " << layer.error().message << ": "
                           << one.profile.bottom_m << " to " << one.profile.top_m;
        bottom.add(layer->heights.bottom_m, one.profile.bottom_m, layer->heights.bottom_error_m);
        top.add(layer->heights.top_m, one.profile.top_m, layer->heights.top_error_m);
    }
    for (const HeightScore* of : {&bottom, &top}) {
        EXPECT_LE(of->rms(), 70);
        EXPECT_LE(of->largest(), 130);
        EXPECT_GE(of->share(of->within), 0.65);
        EXPECT_EQ(of->share(of->within_twice), 1);
    }
}

TEST(MeltingLayer, FindsItsSlopeInSectors) {
    const auto top_at = [](double azimuth_deg) {
        return 2800 + 500 * std::cos(azimuth_deg * degree);
    };
    LayeredSpec spec;
    spec.elevations_deg = {4, 5.1, 6.4, 8, 10};
    const auto layer =
        melting_layer(layered_volume(spec, [&](double azimuth, double, double height) {
            MeltingProfile profile;
            profile.top_m = top_at(azimuth);
            profile.bottom_m = profile.top_m - 500;
            return profile.at(height);
        }));
    ASSERT_TRUE(layer) << layer.error().message;
    for (double azimuth = 15; azimuth < 360; azimuth += 30)
        EXPECT_NEAR(layer->at(azimuth).top_m, top_at(azimuth), 200) << azimuth;
}

// Returns the reason why a volume has no layer.
std::string reason_of(const level2::Volume& volume) {
    const auto layer = melting_layer(volume);
    if (layer)
        return "found from " + std::to_string(layer->heights.bottom_m) + " to " +
               std::to_string(layer->heights.top_m);
    EXPECT_EQ(layer.error().code, ErrorCode::not_found);
    return layer.error().message;
}
const std::string no_layer = "no melting layer found: ";

TEST(MeltingLayer, NeedsDualPolarizationAndSweepsFrom4To10Degrees) {
    const MeltingProfile profile;
    EXPECT_EQ(reason_of({}), no_layer + "the volume has no dual polarization");
    level2::Volume single = volume_with(profile, {});
    for (level2::Sweep& sweep : single.sweeps)
        sweep.moments.resize(1);
    EXPECT_EQ(reason_of(single), no_layer + "the volume has no dual polarization");
    LayeredSpec low;
    low.elevations_deg = {0.5, 2.4};
    EXPECT_EQ(reason_of(volume_with(profile, low)),
              no_layer + "no sweep from 4 to 10 degrees has dual polarization");
}

TEST(MeltingLayer, NeedsEnoughStratiformEcho) {
    const std::string too_little = no_layer + "too little stratiform echo from 4 to 10 degrees";
    LayeredSpec narrow;
    narrow.azimuth_to_deg = 2;
    EXPECT_EQ(reason_of(volume_with({}, narrow)), too_little);
    EXPECT_EQ(reason_of(layered_volume({}, [](double, double, double) { return DualPoint{}; })),
              too_little);
    MeltingProfile drizzle;
    drizzle.rain_dbz = 5;
    EXPECT_EQ(reason_of(volume_with(drizzle, {})), too_little);
}

TEST(MeltingLayer, FindsNoneInRainOrSnowAlone) {
    const std::string no_minimum =
        no_layer + "the correlation coefficient has no minimum between rain and snow";
    for (const bool is_snow : {false, true})
        EXPECT_EQ(reason_of(layered_volume({},
                                           [&](double, double, double height) {
                                               if (height > 6000) return DualPoint{};
                                               return DualPoint{is_snow ? 25 - height / 500 : 35.0,
                                                                is_snow ? 0.2 : 1.0, 0.99, 0};
                                           })),
                  no_minimum);
}

// Cores of hail have a low correlation at all heights, and stand in rain without snow above.
TEST(MeltingLayer, FindsNoneInConvectiveEcho) {
    const auto volume = layered_volume({}, [](double azimuth, double arc, double height) {
        const double across = std::remainder(azimuth, 30) * degree * arc;
        const double along = std::remainder(arc, 15e3);
        const double apart = std::hypot(across, along);
        if (apart > 6000 || height > 8000) return DualPoint{};
        const double dbz = 60 - apart / 300 - std::max(0.0, (height - 5000) / 300);
        return DualPoint{dbz, 1, dbz > 50 ? 0.9 : 0.985, 0};
    });
    EXPECT_EQ(reason_of(volume).substr(0, no_layer.size()), no_layer);
}

TEST(MeltingLayer, SaysThatALayerMayBeginBelowTheLowestHeight) {
    MeltingProfile profile;
    profile.bottom_m = 150;
    profile.top_m = 750;
    EXPECT_EQ(reason_of(volume_with(profile, {})),
              no_layer + "it may begin below the lowest height seen from 4 to 10 degrees");
}

TEST(MeltingLayer, RefusesHeightsThatDisagree) {
    const auto volume = layered_volume({}, [](double azimuth, double, double height) {
        MeltingProfile profile;
        profile.top_m = azimuth < 180 ? 1800 : 3800;
        profile.bottom_m = profile.top_m - 500;
        return profile.at(height);
    });
    EXPECT_EQ(reason_of(volume), no_layer + "the heights of least correlation do not agree");
}

// The antenna of KTLX is 389 m above sea level.
TEST(MeltingLayer, IsComparedWithAnAssumedHeightOf0C) {
    const level2::Volume volume = volume_with({}, {});
    EXPECT_EQ(zero_c_note(volume, 3400), "");
    const std::string note = zero_c_note(volume, 4200);
    EXPECT_NE(note.find("and not at the assumed 4200 m"), std::string::npos) << note;
    EXPECT_EQ(zero_c_in_notes(std::vector<std::string>{"other", "KTLX: " + note}), note);
    EXPECT_EQ(zero_c_in_notes(std::vector<std::string>{"other"}), "");
    EXPECT_EQ(zero_c_note({}, 4200), "");
    level2::Volume nowhere = volume;
    nowhere.station.clear();
    EXPECT_EQ(zero_c_note(nowhere, 4200), "");
}

Result<MeltingLayer> real_layer(const std::string& name) {
    const auto decoded = level2::decode_file(testing::real_file(name));
    if (!decoded) return pass_on(decoded);
    return melting_layer(decoded->volume);
}

// No sounding is at hand. Py-ART's means by height show the least correlation at 2.2 to 2.6 km
// above the antenna, and the correlation of snow from 3.0 km on.
TEST(MeltingLayerOfRealVolumes, IsFoundAtKlbb) {
    STORMCELLAR_NEED_DATA();
    const auto layer = real_layer("volumes/KLBB20160601_150025_V06");
    ASSERT_TRUE(layer) << layer.error().message;
    EXPECT_NEAR(layer->heights.top_m, 2900, 250);
    EXPECT_NEAR(layer->heights.bottom_m, 2200, 250);
}

}  // namespace
}  // namespace stormcellar::retrieve

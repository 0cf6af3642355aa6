// Tests the light of a volume's picture against the reference marcher. On real volumes, tests that
// the picture keeps the lightness and the hues that it has without light.
#include "render/volume/lit_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/color/color_difference.h"
#include "render/color/ok_lab.h"
#include "render/view/fitted_camera.h"
#include "render/volume/reference_marcher.h"
#include "render/volume/slicer.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "tests/render/real_volume.h"
#include "tests/render/synthetic_storm.h"
#include "tests/testing/data.h"

namespace stormcellar::render {
namespace {

OkLab ok_lab_of_srgb(const Rgb& color) {
    LinearRgb linear{};
    for (std::size_t c = 0; c < 3; ++c) {
        const float level = color[c];
        linear[c] = level <= 0.04045F ? level / 12.92F : std::pow((level + 0.055F) / 1.055F, 2.4F);
    }
    return ok_lab_of(linear);
}

double hue_between_deg(const OkLab& one, const OkLab& other) {
    const double turn = std::atan2(one.b, one.a) - std::atan2(other.b, other.a);
    return std::abs(std::remainder(turn, 2 * std::numbers::pi)) * 180 / std::numbers::pi;
}

TEST(LitColor, KeepsTheHueAndFollowsTheFactor) {
    for (const ColorTable& table : {smooth_color_table(level2::Moment::ref), nws_reflectivity()}) {
        for (const ColorStop& stop : table.stops) {
            const Rgb color = {stop.color[0] / 255.0F, stop.color[1] / 255.0F,
                               stop.color[2] / 255.0F};
            const OkLab plain = ok_lab_of_srgb(color);
            float before = 0;
            for (float factor = 0.3F; factor <= 1.8F; factor += 0.1F) {
                const OkLab lit = ok_lab_of_srgb(lit_color(color, factor));
                EXPECT_GE(lit.l, before - 2e-3F) << stop.from << " " << factor;
                before = lit.l;
                if (std::hypot(lit.a, lit.b) < 0.03F) continue;  // gray has no hue
                EXPECT_LT(hue_between_deg(lit, plain), 1.5) << stop.from << " " << factor;
            }
            const OkLab same = ok_lab_of_srgb(lit_color(color, 1));
            EXPECT_NEAR(same.l, plain.l, 2e-3) << stop.from;
        }
    }
}

TEST(LitColor, DarkensAndLightens) {
    const Rgb green = {0.1F, 0.6F, 0.3F};
    EXPECT_LT(ok_lab_of_srgb(lit_color(green, 0.7F)).l, 0.8 * ok_lab_of_srgb(green).l);
    EXPECT_GT(ok_lab_of_srgb(lit_color(green, 1.3F)).l, 1.1 * ok_lab_of_srgb(green).l);
}

// A layer before light is applied to it, and the memory that the slicer uses.
struct Found {
    SlicerRoom room;
    Layer plain;
};
VolumeOptions options_of(const std::string& kinds, int slices, double tolerance = 0) {
    VolumeOptions options{slices, Integration::second_order, 1, tolerance};
    EXPECT_TRUE(set_light(kinds, options.light));
    return options;
}

// Compares the sums of light along rays with the reference marcher, which reads the same field.
TEST(LitLayer, TheSumOfLightAgreesWithTheReference) {
    const grid::GridSpec spec = small_spec(120, 20, 4000, 800);
    const auto bricks = bricks_of(storm_grid(spec));
    Camera camera{163, 58, 1};
    camera.field_of_view_deg = 40;
    for (const bool curved : {false, true}) {
        const ViewGeometry view(spec, camera, 8, 200, 150, curved);
        const VolumeSlicer slicer(nws_reflectivity(), bricks.view().quantization, view,
                                  options_of("gradient,shadow", 1024));
        SlicerRoom room;
        slicer.prepare(bricks.view(), 2, room);
        slicer.cast(bricks.view(), 2, room);
        const ReferenceMarcher reference(bricks.view(), nws_reflectivity(), view, 1);
        double worst = 0, sum = 0, apart = 0;
        int count = 0;
        for (int y = 3; y < 150; y += 9) {
            for (int x = 3; x < 200; x += 9) {
                const auto slow = reference.lit_ray({x + 0.5, y + 0.5}, 2048, &*room.shades);
                const double fast = room.light[static_cast<std::size_t>(y * 200 + x)];
                worst = std::max(worst, std::abs(slow.light - fast));
                sum += (slow.light - fast) * (slow.light - fast);
                apart = std::max(apart, std::abs(slow.light - slow.color[3]));
                ++count;
            }
        }
        EXPECT_LT(std::sqrt(sum / count), 0.006) << curved;
        EXPECT_GT(apart, 0.05) << "the light is not 1 everywhere";
    }
}

// Interpolates pixels of a lit picture between rays, and compares them with cast rays.
TEST(LitLayer, IsInterpolatedWhereThePictureIsStraight) {
    const grid::GridSpec spec = small_spec(40, 20, 8000, 800);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry view(spec, {180, 50, 1}, 8, 240, 180);
    const auto draw = [&](double tolerance) {
        return sliced(bricks.view(), view, options_of("gradient,shadow", 256, tolerance));
    };
    const Layer all = draw(0), some = draw(2.0 / 255);
    double worst = 0;
    std::size_t unequal = 0;
    for (std::size_t i = 0; i < all.rgba.size(); ++i) {
        worst = std::max(worst, std::abs(static_cast<double>(all.rgba[i] - some.rgba[i])));
        unequal += all.rgba[i] != some.rgba[i] ? 1 : 0;
    }
    EXPECT_GT(unequal, 0U);
    EXPECT_LT(worst, 0.12);
}

grid::Grid real_grid(const std::string& file) {
    return real_reflectivity("volumes/" + file, 2000, 230);
}

grid::BrickGrid bricks_of_real(const grid::Grid& grid) {
    return grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
}

// Returns the lightness (L*) of the echo at a pixel, without its background.
double lightness_at(const Layer& layer, std::size_t i) {
    const auto level = [&](std::size_t c) {
        const float whole = layer.rgba[i + c] / layer.rgba[i + 3];
        return static_cast<std::uint8_t>(std::lround(std::clamp(255 * whole, 0.0F, 255.0F)));
    };
    return lab_of({level(0), level(1), level(2), 255}).lightness;
}

struct Lightness {
    double mean = 0, hue_p95_deg = 0, lighter = 0, darker = 0;
};
// Compares the pixels in which echo covers at least a tenth.
Lightness lightness_of(const Layer& lit, const Layer& plain, double& mean_plain) {
    Lightness found;
    double sum = 0, sum_plain = 0, weight = 0;
    std::vector<double> turns;
    for (std::size_t i = 0; i < lit.rgba.size(); i += 4) {
        const float alpha = plain.rgba[i + 3];
        EXPECT_EQ(lit.rgba[i + 3], alpha);
        if (alpha < 0.1F) continue;
        const auto color = [&](const Layer& layer) {
            return Rgb{layer.rgba[i] / alpha, layer.rgba[i + 1] / alpha, layer.rgba[i + 2] / alpha};
        };
        const double l = lightness_at(lit, i);
        const double l_plain = lightness_at(plain, i);
        sum += static_cast<double>(alpha) * l;
        sum_plain += static_cast<double>(alpha) * l_plain;
        weight += static_cast<double>(alpha);
        found.lighter += l > l_plain + 2 ? 1 : 0;
        found.darker += l < l_plain - 2 ? 1 : 0;
        const OkLab one = ok_lab_of_srgb(color(lit)), other = ok_lab_of_srgb(color(plain));
        if (std::min(std::hypot(one.a, one.b), std::hypot(other.a, other.b)) > 0.03F) {
            turns.push_back(hue_between_deg(one, other));
        }
    }
    std::ranges::sort(turns);
    found.hue_p95_deg = turns[turns.size() * 95 / 100];
    found.mean = sum / weight;
    mean_plain = sum_plain / weight;
    return found;
}

class LitVolume : public ::testing::TestWithParam<const char*> {};

TEST_P(LitVolume, KeepsItsLightnessAndItsHues) {
    STORMCELLAR_NEED_DATA();
    const auto bricks = bricks_of_real(real_grid(GetParam()));
    const EchoOutline outline(bricks.view(), level2::Moment::ref);
    Scene scene;
    apply(fit_view(outline, scene, 400, 300), scene);
    const ViewGeometry view(*bricks.view().spec, scene.camera, scene.vertical_exaggeration, 400,
                            300);
    for (const ColorTable* table :
         {&nws_reflectivity(), &smooth_color_table(level2::Moment::ref)}) {
        for (const char* kinds : {"gradient,shadow", "gradient", "shadow", "scattering"}) {
            const auto draw = [&](const std::string& names) {
                VolumeOptions options = options_of(names, 128);
                options.opacity = scene.opacity;
                options.light.sun_azimuth_deg = scene.light.sun_azimuth_deg;
                return sliced(bricks.view(), view, options, 2, *table);
            };
            double plain = 0;
            const Lightness lit = lightness_of(draw(kinds), draw("none"), plain);
            EXPECT_NEAR(lit.mean, plain, 1) << table->name << " " << kinds;
            EXPECT_LT(lit.hue_p95_deg, 1.5) << table->name << " " << kinds;
            if (std::string(kinds) != "gradient,shadow") continue;
            EXPECT_GT(lit.lighter, 0.1 * lit.darker) << "lit sides are lighter";
            EXPECT_GT(lit.darker, 0.1 * lit.lighter) << "shaded sides are darker";
        }
    }
}

// Each frame has an exposure of its own, which must not be visible in a loop. If half of all echo
// disappears from one frame to the next, the rest must stay as light as before.
TEST_P(LitVolume, IsAsLightWhenOtherEchoGoes) {
    STORMCELLAR_NEED_DATA();
    const grid::Grid whole = real_grid(GetParam());
    grid::Grid half = whole;
    for (std::size_t cell = 0; cell < half.status.size(); ++cell) {
        const auto column = cell / half.spec.levels_m.size();
        const bool goes = column % static_cast<std::size_t>(half.spec.nx) > 115;
        if (goes && half.status[cell] == grid::CellStatus::value)
            half.status[cell] = grid::CellStatus::no_echo;
    }
    const auto before = bricks_of_real(whole);
    const auto after = bricks_of_real(half);
    Scene scene;
    apply(fit_view(EchoOutline(before.view(), level2::Moment::ref), scene, 400, 300), scene);
    const ViewGeometry view(*before.view().spec, scene.camera, scene.vertical_exaggeration, 400,
                            300);
    const auto draw = [&](const grid::BrickGrid& bricks, const char* names) {
        VolumeOptions options = options_of(names, 128);
        options.opacity = scene.opacity;
        options.light.sun_azimuth_deg = scene.light.sun_azimuth_deg;
        return sliced(bricks.view(), view, options, 2, smooth_color_table(level2::Moment::ref));
    };
    const Layer plain = draw(before, "none"), plain_after = draw(after, "none");
    const Layer lit = draw(before, "gradient,shadow"), lit_after = draw(after, "gradient,shadow");
    double change = 0;
    int pixels = 0;
    for (std::size_t i = 0; i < plain.rgba.size(); i += 4) {
        if (plain.rgba[i + 3] < 0.1F || plain.rgba[i + 3] != plain_after.rgba[i + 3]) continue;
        change += lightness_at(lit_after, i) - lightness_at(lit, i);
        ++pixels;
    }
    ASSERT_GT(pixels, 1000);
    EXPECT_NEAR(change / pixels, 0, 1.5);
}

INSTANTIATE_TEST_SUITE_P(Real, LitVolume,
                         ::testing::Values("KTLX19990503_235621.gz",
                                           "KCRP20170826_044114.trimmed.ar2v",
                                           "KDMX20220305_232324.trimmed.ar2v",
                                           "KOKX20080109_141449.gz", "KLBB20160601_150025_V06"));

}  // namespace
}  // namespace stormcellar::render

#include "render/color/smooth_tables.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "render/color/built_in_tables.h"
#include "render/color/color_difference.h"
#include "render/color/ok_lab.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

constexpr float lowest_velocity = -64, lowest_zdr = -13;
constexpr int pieces_between_anchors = 8;

struct Anchor {
    float value;
    std::uint32_t rgb;
    float alpha = 1;  // on maps
};

std::uint8_t level_of(float linear) {
    const double bounded = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    const double level =
        bounded <= 0.0031308 ? 12.92 * bounded : 1.055 * std::pow(bounded, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * level));
}

OkLab lab_of_anchor(const Anchor& anchor) {
    const auto channel = [&](unsigned shift) {
        return static_cast<float>(
            linear_of(static_cast<std::uint8_t>(anchor.rgb >> shift & 0xFFU)));
    };
    return ok_lab_of({channel(16), channel(8), channel(0)});
}

// Returns the color at a share of the way between two anchors.
Rgba8 color_between(const Anchor& from, const Anchor& to, float share) {
    const OkLab a = lab_of_anchor(from), b = lab_of_anchor(to);
    const LinearRgb linear = linear_of(
        OkLab{std::lerp(a.l, b.l, share), std::lerp(a.a, b.a, share), std::lerp(a.b, b.b, share)});
    const float alpha = std::lerp(from.alpha, to.alpha, share);
    return {level_of(linear[0]), level_of(linear[1]), level_of(linear[2]),
            static_cast<std::uint8_t>(std::lround(255 * alpha))};
}

// Tables blend in sRGB, so that the way between two anchors is cut into short pieces.
ColorTable smooth_table(std::string_view name, Moment moment, std::span<const Anchor> anchors,
                        float end) {
    ColorTable table;
    table.name = name;
    table.moment = moment;
    table.unit = unit_of(moment);
    table.end = end;
    table.range_folded = usual_range_folded;
    for (std::size_t i = 0; i + 1 < anchors.size(); ++i) {
        const Anchor &from = anchors[i], &to = anchors[i + 1];
        for (int piece = 0; piece < pieces_between_anchors; ++piece) {
            const auto share = [](int k) {
                return static_cast<float>(k) / static_cast<float>(pieces_between_anchors);
            };
            table.stops.push_back({std::lerp(from.value, to.value, share(piece)),
                                   color_between(from, to, share(piece)),
                                   color_between(from, to, share(piece + 1))});
        }
    }
    const Rgba8 last = color_between(anchors.back(), anchors.back(), 0);
    table.stops.push_back({anchors.back().value, last, last});
    table.extinction = default_extinction(moment, table.lowest());
    return table;
}

ColorTable smooth_reflectivity() {
    constexpr Anchor anchors[] = {
        {5, 0x6F9BB8, 0.12F},     {12, 0x4FA3E0, 0.38F}, {19.5F, 0x3A78E6, 0.79F},
        {20.5F, 0x5FE08A, 0.81F}, {25, 0x3DCC70, 1},     {27, 0x2FC462, 1},
        {34.5F, 0x14974A, 1},     {35.5F, 0xFFF36B, 1},  {41, 0xFFD23C, 1},
        {46, 0xFFA02A, 1},        {49.5F, 0xFF7420, 1},  {50.5F, 0xFB3434, 1},
        {56, 0xDC1430, 1},        {62, 0xB80F3C, 1},     {64.5F, 0xA80E48, 1},
        {65.5F, 0xFFA8F4, 1},     {70, 0xEBCBFF, 1},     {75, 0xFFFFFF, 1},
    };
    return smooth_table("smooth-reflectivity", Moment::ref, anchors, 80);
}

// Colors for insects, birds and dust, which the other reflectivity table leaves out.
ColorTable smooth_clear_air() {
    constexpr Anchor anchors[] = {
        {-30, 0x343C48, 0.1F}, {-15, 0x4A6B80, 0.5F}, {-5, 0x4A93A3, 0.8F}, {5, 0x62BFA0, 1},
        {15, 0x9CC868, 1},     {25, 0xE6CC40, 1},     {37, 0xFFF6D0, 1},    {50, 0xFFFFFF, 1},
    };
    ColorTable table = smooth_table("smooth-clear-air", Moment::ref, anchors, 55);
    table.extinction = {{-30, 0.004}, {-15, 0.01}, {-5, 0.025}, {5, 0.07}, {15, 0.2}, {35, 1}};
    return table;
}

ColorTable smooth_velocity() {
    constexpr Anchor anchors[] = {
        {lowest_velocity, 0xF4FFFD},
        {-50, 0xBDF3EA},
        {-40, 0x92EBE2},
        {-30, 0x4FCBCB},
        {-20, 0x22A6B4},
        {-10, 0x1A7890},
        {-2, 0x4A6470},
        {0, 0x5C5C5E},
        {2, 0x74534F},
        {10, 0xAA3B35},
        {20, 0xE04B2E},
        {30, 0xFF8A3C},
        {40, 0xFFB962},
        {50, 0xFFDD9C},
        {64, 0xFFF8EA},
    };
    ColorTable table = smooth_table("smooth-velocity", Moment::vel, anchors, 65);
    table.bar_begin = -50.0F;
    table.end = 65;
    return table;
}

ColorTable smooth_spectrum_width() {
    constexpr Anchor anchors[] = {
        {0, 0x2F3A4A}, {2, 0x3B5B86},  {4, 0x3F86A8},  {6, 0x56B59B},
        {8, 0xA3D36B}, {10, 0xF3E24F}, {14, 0xFFF9DA},
    };
    return smooth_table("smooth-spectrum-width", Moment::sw, anchors, 15);
}

ColorTable smooth_zdr() {
    constexpr Anchor anchors[] = {
        {lowest_zdr, 0x120F1C}, {-4, 0x1E1A30}, {-2, 0x40346C}, {0, 0x3F4FA3},
        {0.5F, 0x2F6FBE},       {1, 0x2A93B8},  {2, 0x3FBF8F},  {3, 0x8CCB52},
        {4, 0xE6CC36},          {6, 0xFFF4C8},  {8, 0xFFFDF2},
    };
    ColorTable table = smooth_table("smooth-zdr", Moment::zdr, anchors, 8.5F);
    table.bar_begin = -4.0F;
    return table;
}

ColorTable smooth_rho() {
    constexpr Anchor anchors[] = {
        {0.2F, 0x251C3A},  {0.5F, 0x3B2F6B},  {0.7F, 0x4A4FA0}, {0.8F, 0x3478B4},  {0.9F, 0x2FAE9E},
        {0.95F, 0x7ACB5E}, {0.98F, 0xEBDD48}, {1, 0xFFF3C0},    {1.05F, 0xFFFCF0},
    };
    return smooth_table("smooth-rho", Moment::rho, anchors, 1.06F);
}

ColorTable smooth_phi() {
    constexpr Anchor anchors[] = {
        {0, 0x3B2F7E},   {60, 0x2F7FD0},  {120, 0x4FBDBD}, {180, 0xEEF7CC},
        {240, 0xF0A83A}, {300, 0xB23A2E}, {360, 0x3B2F7E},
    };
    return smooth_table("smooth-phi", Moment::phi, anchors, 361);
}

ColorTable smooth_cfp() {
    constexpr Anchor anchors[] = {
        {0, 0x39404C},  {10, 0x3D6691}, {20, 0x3F97A6},
        {30, 0x79C583}, {40, 0xE3DB55}, {55, 0xFFF8DC},
    };
    return smooth_table("smooth-cfp", Moment::cfp, anchors, 60);
}

}  // namespace

std::vector<ColorTable> make_smooth_tables() {
    return {smooth_reflectivity(), smooth_velocity(), smooth_spectrum_width(),
            smooth_zdr(),          smooth_phi(),      smooth_rho(),
            smooth_cfp(),          smooth_clear_air()};
}

}  // namespace stormcellar::render

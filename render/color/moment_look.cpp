#include "render/color/moment_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "render/color/built_in_tables.h"
#include "render/color/color_difference.h"
#include "render/color/ok_lab.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

constexpr float lowest_velocity = -64, lowest_zdr = -13, lowest_shear = -128;
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

// Returns the color between two anchors, at a share of the way from the first to the second.
Rgba8 color_between(const Anchor& from, const Anchor& to, float share) {
    const OkLab a = lab_of_anchor(from), b = lab_of_anchor(to);
    const LinearRgb linear = linear_of(
        OkLab{std::lerp(a.l, b.l, share), std::lerp(a.a, b.a, share), std::lerp(a.b, b.b, share)});
    const float alpha = std::lerp(from.alpha, to.alpha, share);
    return {level_of(linear[0]), level_of(linear[1]), level_of(linear[2]),
            static_cast<std::uint8_t>(std::lround(255 * alpha))};
}

constexpr Anchor reflectivity_anchors[] = {
    {5, 0x6F9BB8, 0.12F}, {12, 0x4FA3E0, 0.38F}, {19.5F, 0x3A78E6, 0.79F}, {20.5F, 0x5FE08A, 0.81F},
    {25, 0x3DCC70, 1},    {27, 0x2FC462, 1},     {34.5F, 0x14974A, 1},     {35.5F, 0xFFF36B, 1},
    {41, 0xFFD23C, 1},    {46, 0xFFA02A, 1},     {49.5F, 0xFF7420, 1},     {50.5F, 0xFB3434, 1},
    {56, 0xDC1430, 1},    {62, 0xB80F3C, 1},     {64.5F, 0xA80E48, 1},     {65.5F, 0xFFA8F4, 1},
    {70, 0xEBCBFF, 1},    {75, 0xFFFFFF, 1},
};

// Colors for insects, birds and dust, which smooth-reflectivity does not show.
constexpr Anchor clear_air_anchors[] = {
    {-30, 0x343C48, 0.1F}, {-15, 0x4A6B80, 0.5F}, {-5, 0x4A93A3, 0.8F}, {5, 0x62BFA0, 1},
    {15, 0x9CC868, 1},     {25, 0xE6CC40, 1},     {37, 0xFFF6D0, 1},    {50, 0xFFFFFF, 1},
};

constexpr Anchor velocity_anchors[] = {
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

constexpr Anchor shear_anchors[] = {
    {lowest_shear, 0xF2F7FF},
    {-40, 0xDCE9FF},
    {-20, 0xA9C8FF},
    {-12, 0x6FA0F5},
    {-8, 0x4A80DC},
    {-5, 0x3A68B4},
    {-3, 0x42597F},
    {-1, 0x55585E},
    {0, 0x5A5A5A},
    {1, 0x625850},
    {3, 0x8A5F3A},
    {5, 0xB8702C},
    {8, 0xD27A1E},
    {12, 0xF09A24},
    {20, 0xFFDD80},
    {40, 0xFFF0B8},
};

constexpr Anchor spectrum_width_anchors[] = {
    {0, 0x2F3A4A}, {2, 0x3B5B86},  {4, 0x3F86A8},  {6, 0x56B59B},
    {8, 0xA3D36B}, {10, 0xF3E24F}, {14, 0xFFF9DA},
};

constexpr Anchor zdr_anchors[] = {
    {lowest_zdr, 0x120F1C}, {-4, 0x1E1A30}, {-2, 0x40346C}, {0, 0x3F4FA3},
    {0.5F, 0x2F6FBE},       {1, 0x2A93B8},  {2, 0x3FBF8F},  {3, 0x8CCB52},
    {4, 0xE6CC36},          {6, 0xFFF4C8},  {8, 0xFFFDF2},
};

constexpr Anchor rho_anchors[] = {
    {0.2F, 0x251C3A},  {0.5F, 0x3B2F6B},  {0.7F, 0x4A4FA0}, {0.8F, 0x3478B4},  {0.9F, 0x2FAE9E},
    {0.95F, 0x7ACB5E}, {0.98F, 0xEBDD48}, {1, 0xFFF3C0},    {1.05F, 0xFFFCF0},
};

constexpr Anchor quality_anchors[] = {
    {0, 0x3F2A4A},     {0.25F, 0x5F3B62}, {0.45F, 0x80566A},
    {0.55F, 0x7E8F70}, {0.75F, 0x8CC08A}, {1, 0xE4F6DA},
};

constexpr Anchor kdp_anchors[] = {
    {-2, 0x14101F},   {-0.75F, 0x2C2347}, {-0.2F, 0x3F3F4C}, {0.2F, 0x4A5060}, {0.75F, 0x2F6FBE},
    {1.5F, 0x2A8FB8}, {2.5F, 0x35A584},   {3.5F, 0x52B055},  {5, 0xEEDD55},    {8, 0xFFFBEA},
};

constexpr Anchor rain_anchors[] = {
    {0, 0x2C3550},  {0.2F, 0x33436A}, {1, 0x3A5590},  {2.5F, 0x2F6FBE}, {6, 0x2A8FB8},
    {12, 0x35A584}, {25, 0x52B055},   {45, 0xD9CC3C}, {70, 0xFFF0B0},   {100, 0xFFFDF2},
};

constexpr Anchor phi_anchors[] = {
    {0, 0x3B2F7E},   {60, 0x2F7FD0},  {120, 0x4FBDBD}, {180, 0xEEF7CC},
    {240, 0xF0A83A}, {300, 0xB23A2E}, {360, 0x3B2F7E},
};

constexpr Anchor cfp_anchors[] = {
    {0, 0x39404C}, {10, 0x3D6691}, {20, 0x3F97A6}, {30, 0x79C583}, {40, 0xE3DB55}, {55, 0xFFF8DC},
};

struct SmoothTable {
    std::string_view name;
    Moment moment;
    std::span<const Anchor> anchors;
    float end;  // where the color bar ends
    std::optional<float> bar_begin = std::nullopt;
};
constexpr std::array smooth_tables{
    SmoothTable{"smooth-reflectivity", Moment::ref, reflectivity_anchors, 80},
    SmoothTable{"smooth-velocity", Moment::vel, velocity_anchors, 65, -50.0F},
    SmoothTable{"smooth-spectrum-width", Moment::sw, spectrum_width_anchors, 15},
    SmoothTable{"smooth-zdr", Moment::zdr, zdr_anchors, 8.5F, -4.0F},
    SmoothTable{"smooth-phi", Moment::phi, phi_anchors, 361},
    SmoothTable{"smooth-rho", Moment::rho, rho_anchors, 1.06F},
    SmoothTable{"smooth-cfp", Moment::cfp, cfp_anchors, 60},
    SmoothTable{"smooth-shear", Moment::azsh, shear_anchors, 41, -40.0F},
    SmoothTable{"smooth-quality", Moment::pow, quality_anchors, 1.01F},
    SmoothTable{"smooth-kdp", Moment::kdp, kdp_anchors, 8.1F, -2.0F},
    SmoothTable{"smooth-rain", Moment::rate, rain_anchors, 101},
    SmoothTable{"smooth-clear-air", Moment::ref, clear_air_anchors, 55},
};

// Makes a table that is even in OKLab. Tables blend in sRGB, so the way from anchor to anchor in
// OKLab is cut into short pieces.
ColorTable blended_table(const SmoothTable& smooth) {
    const std::span<const Anchor> anchors = smooth.anchors;
    ColorTable table;
    table.name = smooth.name;
    table.moment = smooth.moment;
    table.unit = unit_of(smooth.moment);
    table.end = smooth.end;
    table.bar_begin = smooth.bar_begin;
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
    table.extinction = default_extinction(smooth.moment, table.lowest());
    return table;
}

// Between these points, the opacity of reflectivity is exponential in the value.
constexpr ExtinctionPoint reflectivity_points[] = {
    {5, 0.0015}, {10, 0.003}, {15, 0.005}, {20, 0.012}, {25, 0.025}, {30, 0.042}, {35, 0.055},
    {40, 0.09},  {45, 0.25},  {50, 1.1},   {55, 2.5},   {60, 4},     {75, 6},
};

std::vector<ExtinctionPoint> reflectivity_extinction(float lowest) {
    const std::span<const ExtinctionPoint> known = reflectivity_points;
    std::vector<ExtinctionPoint> points;
    const int first = static_cast<int>(std::floor(std::clamp(lowest, -32.0F, 79.0F)));
    std::size_t after = 1;
    for (int dbz = first; dbz <= 80; ++dbz) {
        const auto value = static_cast<float>(dbz);
        while (after + 1 < known.size() && known[after].value < value)
            ++after;
        const ExtinctionPoint &from = known[after - 1], &to = known[after];
        const double share = std::clamp(
            static_cast<double>((value - from.value) / (to.value - from.value)), 0.0, 1.0);
        points.push_back({value, from.per_km * std::pow(to.per_km / from.per_km, share)});
    }
    return points;
}

std::vector<ExtinctionPoint> velocity_extinction(float /*lowest*/) {
    return {{lowest_velocity, 0.5},
            {-50, 0.5},
            {-30, 0.2},
            {-10, 0.03},
            {0, 0.006},
            {10, 0.03},
            {30, 0.2},
            {50, 0.5}};
}
std::vector<ExtinctionPoint> shear_extinction(float /*lowest*/) {
    return {{lowest_shear, 1}, {-20, 0.6}, {-10, 0.15}, {-4, 0.01}, {0, 0.001},
            {4, 0.01},         {10, 0.15}, {20, 0.6},   {128, 1}};
}
std::vector<ExtinctionPoint> spectrum_width_extinction(float /*lowest*/) {
    return {{0, 0.004}, {4, 0.03}, {8, 0.12}, {12, 0.4}};
}
std::vector<ExtinctionPoint> zdr_extinction(float /*lowest*/) {
    return {{lowest_zdr, 0.02}, {0.5, 0.02}, {2, 0.06}, {4, 0.25}};
}
std::vector<ExtinctionPoint> phi_extinction(float /*lowest*/) {
    return {{0, 0.015}};
}
std::vector<ExtinctionPoint> rho_extinction(float /*lowest*/) {
    return {{0, 0.06}, {0.85F, 0.06}, {0.97F, 0.02}};
}
std::vector<ExtinctionPoint> quality_extinction(float /*lowest*/) {
    return {{0, 0.02}, {0.5F, 0.04}, {1, 0.06}};
}
std::vector<ExtinctionPoint> kdp_extinction(float lowest) {
    return {{lowest, 0.005}, {0.5F, 0.02}, {2, 0.3}, {5, 1.5}};
}
std::vector<ExtinctionPoint> rain_extinction(float /*lowest*/) {
    return {{0, 0.001}, {2, 0.01}, {10, 0.06}, {50, 0.8}, {100, 2}};
}
// Classes are not drawn as volumes.
std::vector<ExtinctionPoint> class_extinction(float /*lowest*/) {
    return {{0, 0.02}};
}
std::vector<ExtinctionPoint> cfp_extinction(float /*lowest*/) {
    return {{0, 0.005}, {10, 0.04}, {30, 0.3}};
}

constexpr auto moment_looks = std::to_array<MomentLook>({
    {Moment::ref, "Reflectivity", "nws-reflectivity", "smooth-reflectivity",
     reflectivity_extinction, false, true},
    {Moment::vel, "Radial velocity", "nws-velocity", "smooth-velocity", velocity_extinction},
    {Moment::sw, "Spectrum width", "nws-spectrum-width", "smooth-spectrum-width",
     spectrum_width_extinction, true, true},
    {Moment::zdr, "Differential reflectivity", "nws-zdr", "smooth-zdr", zdr_extinction},
    {Moment::phi, "Differential phase", "phi", "smooth-phi", phi_extinction, true},
    {Moment::rho, "Correlation coefficient", "nws-rho", "smooth-rho", rho_extinction},
    {Moment::cfp, "Clutter filter power removed", "cfp", "smooth-cfp", cfp_extinction, true},
    {Moment::veld, "Dealiased velocity", "nws-velocity", "smooth-velocity", velocity_extinction},
    {Moment::srv, "Storm-relative velocity", "nws-velocity", "smooth-velocity",
     velocity_extinction},
    {Moment::azsh, "Azimuthal shear", "smooth-shear", "smooth-shear", shear_extinction},
    {Moment::divg, "Radial divergence", "smooth-shear", "smooth-shear", shear_extinction},
    {Moment::pow, "Probability of weather", "smooth-quality", "smooth-quality", quality_extinction},
    {Moment::kdp, "Specific differential phase", "smooth-kdp", "smooth-kdp", kdp_extinction},
    {Moment::rate, "Rain rate", "smooth-rain", "smooth-rain", rain_extinction, true, true},
    {Moment::hca, "Hydrometeor class", "hydrometeors", "hydrometeors", class_extinction, true},
});
static_assert(level2::has_a_row_for_each_moment(moment_looks));

}  // namespace

const MomentLook& look_of(Moment moment) {
    return moment_looks[static_cast<std::size_t>(moment)];
}

std::string unit_of(Moment moment) {
    const std::string_view units = level2::moment_units(moment);
    return units == "1" ? std::string{} : std::string(units);
}

std::vector<ExtinctionPoint> default_extinction(Moment moment, float lowest) {
    return look_of(moment).extinction(lowest);
}

std::vector<ColorTable> make_smooth_tables() {
    std::vector<ColorTable> tables;
    for (const SmoothTable& smooth : smooth_tables)
        tables.push_back(blended_table(smooth));
    // Echo of clear air is weak, so volumes show it denser than other reflectivity.
    tables.back().extinction = {{-30, 0.004}, {-15, 0.01}, {-5, 0.025},
                                {5, 0.07},    {15, 0.2},   {35, 1}};
    return tables;
}

}  // namespace stormcellar::render

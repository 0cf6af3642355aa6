#include "render/color/color_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "base/degree.h"

namespace stormcellar::render {
namespace {

double linear_channel(int stored) {
    const double share = stored / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

// Returns the cube root that CIE Lab uses. Near black it is a straight line.
double lab_root(double share) {
    constexpr double bend = 216.0 / 24389;
    return share > bend ? std::cbrt(share) : (24389.0 / 27 * share + 16) / 116;
}

// Returns sqrt(c^7 / (c^7 + 25^7)).
double seventh_power_share(double chroma) {
    constexpr double of_25 = 6103515625.0;
    const double cube = chroma * chroma * chroma;
    const double power = cube * cube * chroma;
    return std::sqrt(power / (power + of_25));
}

// A color as chroma and hue. The plane is that of the formula, in which colors near gray are
// stretched along a.
struct Polar {
    double chroma = 0;
    double hue_deg = 0;  // 0..360; 0 for gray
};

Polar polar_of(double a, double b) {
    Polar polar{std::hypot(a, b), 0};
    if (polar.chroma <= 0) return polar;
    polar.hue_deg = std::atan2(b, a) / degree;
    if (polar.hue_deg < 0) polar.hue_deg += 360;
    return polar;
}

struct Hues {
    double difference_deg = 0;
    double mean_deg = 0;
};

// Returns the difference of two hues by the shorter way around, and the middle between them.
Hues hues_of(const Polar& one, const Polar& other) {
    constexpr double half_turn = 180 + 1e-9;
    const double sum = one.hue_deg + other.hue_deg;
    if (one.chroma <= 0 || other.chroma <= 0) return {0, sum};
    const double difference = other.hue_deg - one.hue_deg;
    if (std::abs(difference) <= half_turn) return {difference, sum / 2};
    return {difference > 0 ? difference - 360 : difference + 360,
            sum < 360 ? (sum + 360) / 2 : (sum - 360) / 2};
}

// Returns the weight of a difference in hue, T in the formula, for a mean hue.
double hue_weight(double mean_deg) {
    return 1 - 0.17 * std::cos((mean_deg - 30) * degree) + 0.24 * std::cos(2 * mean_deg * degree) +
           0.32 * std::cos((3 * mean_deg + 6) * degree) -
           0.20 * std::cos((4 * mean_deg - 63) * degree);
}

}  // namespace

double linear_of(std::uint8_t channel) {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> values{};
        for (int i = 0; i < 256; ++i)
            values[static_cast<std::size_t>(i)] = linear_channel(i);
        return values;
    }();
    return table[channel];
}

Lab lab_of_linear(double red, double green, double blue) {
    // The rows of the matrix of the primaries. The sums of the rows are the white.
    const double x = (0.4124 * red + 0.3576 * green + 0.1805 * blue) / (0.4124 + 0.3576 + 0.1805);
    const double y = (0.2126 * red + 0.7152 * green + 0.0722 * blue) / (0.2126 + 0.7152 + 0.0722);
    const double z = (0.0193 * red + 0.1192 * green + 0.9505 * blue) / (0.0193 + 0.1192 + 0.9505);
    const double fy = lab_root(y);
    return {116 * fy - 16, 500 * (lab_root(x) - fy), 200 * (fy - lab_root(z))};
}

Lab lab_of(const Rgba8& color) {
    return lab_of_linear(linear_of(color[0]), linear_of(color[1]), linear_of(color[2]));
}

double ciede2000(const Lab& one, const Lab& other) {
    const double stretch =
        1.5 -
        0.5 * seventh_power_share((std::hypot(one.a, one.b) + std::hypot(other.a, other.b)) / 2);
    const Polar first = polar_of(stretch * one.a, one.b);
    const Polar second = polar_of(stretch * other.a, other.b);
    const Hues hues = hues_of(first, second);
    const double mean_chroma = (first.chroma + second.chroma) / 2;
    const double off_middle = (one.lightness + other.lightness) / 2 - 50;

    const double lightness =
        (other.lightness - one.lightness) /
        (1 + 0.015 * off_middle * off_middle / std::sqrt(20 + off_middle * off_middle));
    const double chroma = (second.chroma - first.chroma) / (1 + 0.045 * mean_chroma);
    const double hue = 2 * std::sqrt(first.chroma * second.chroma) *
                       std::sin(hues.difference_deg / 2 * degree) /
                       (1 + 0.015 * mean_chroma * hue_weight(hues.mean_deg));

    // For blues, chroma and hue depend on each other.
    const double from_blue = (hues.mean_deg - 275) / 25;
    const double turn = 60 * std::exp(-from_blue * from_blue) * degree;
    const double rotation = -2 * seventh_power_share(mean_chroma) * std::sin(turn);
    const double square =
        lightness * lightness + chroma * chroma + hue * hue + rotation * chroma * hue;
    return std::sqrt(std::max(0.0, square));
}

double color_difference(const Rgba8& one, const Rgba8& other) {
    return ciede2000(lab_of(one), lab_of(other));
}

Result<ImageDifference> image_difference(const Image& one, const Image& other) {
    if (one.width != other.width || one.height != other.height || one.rgba.empty()) {
        return fail(ErrorCode::bad_argument,
                    "pictures to compare must be of one size, not {} x {} and {} x {}", one.width,
                    one.height, other.width, other.height);
    }
    ImageDifference summary;
    summary.pixels = one.rgba.size() / 4;
    // Differences of the pixels that differ; for all other pixels the difference is 0.
    std::vector<double> differences;
    std::unordered_map<std::uint64_t, double> known;  // most pictures repeat a few pairs of colors
    for (std::size_t i = 0; i < one.rgba.size(); i += 4) {
        const Rgba8 p = {one.rgba[i], one.rgba[i + 1], one.rgba[i + 2], 255};
        const Rgba8 q = {other.rgba[i], other.rgba[i + 1], other.rgba[i + 2], 255};
        if (p == q) continue;
        std::uint64_t key = 0;
        for (std::size_t c = 0; c < 3; ++c)
            key = key << 16U | static_cast<std::uint64_t>(p[c]) << 8U | q[c];
        const auto [place, is_new] = known.try_emplace(key, 0.0);
        if (is_new) place->second = color_difference(p, q);
        differences.push_back(place->second);
    }
    summary.unequal = differences.size();
    if (differences.empty()) return summary;

    std::sort(differences.begin(), differences.end());
    double sum = 0;
    for (const double difference : differences)
        sum += difference;
    summary.mean = sum / static_cast<double>(summary.pixels);
    summary.max = differences.back();
    // Number of pixels that may be above the percentile.
    const std::size_t above = summary.pixels / 100;
    if (above < differences.size()) {
        summary.percentile_99 = differences[differences.size() - 1 - above];
    }
    return summary;
}

}  // namespace stormcellar::render

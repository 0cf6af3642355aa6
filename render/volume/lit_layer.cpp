#include "render/volume/lit_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/parallel.h"
#include "render/color/ok_lab.h"

namespace stormcellar::render {
namespace {

constexpr float strength = 0.9F;  // larger values turn yellow into brown and red into pink
constexpr float lightening = 1.6F * strength;
constexpr float darkest_share = 0.5F, lightest = 0.98F;
constexpr float least_alpha = 1.0F / 512;  // pixels with less opacity show no light
constexpr float least_exposure = 0.7F, most_exposure = 1.4F;
constexpr int exposure_steps = 10, exposure_stride = 5;

// A function of 0 to 1, as a table with straight lines between its entries.
template <std::size_t count>
class UnitTable {
  public:
    template <class Function>
    explicit UnitTable(Function function) {
        for (std::size_t i = 0; i <= count; ++i)
            values_[i] = static_cast<float>(function(static_cast<double>(i) / count));
        values_[count + 1] = values_[count];
    }
    [[nodiscard]] float operator()(float x) const {
        const float place = std::clamp(x, 0.0F, 1.0F) * static_cast<float>(count);
        const auto below = static_cast<std::size_t>(place);
        return values_[below] +
               (values_[below + 1] - values_[below]) * (place - static_cast<float>(below));
    }

  private:
    std::array<float, count + 2> values_{};
};

double linear_of_srgb(double level) {
    return level <= 0.04045 ? level / 12.92 : std::pow((level + 0.055) / 1.055, 2.4);
}
// Returns the sRGB level for the square root of linear light. Tables of this function have equal
// steps in the root, because sRGB is steep near black.
double srgb_of_root(double root) {
    const double linear = root * root;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

float to_linear(float level) {
    static const UnitTable<1024> table(linear_of_srgb);
    return table(level);
}
float to_srgb(float linear) {
    static const UnitTable<1024> table(srgb_of_root);
    return table(std::sqrt(std::clamp(linear, 0.0F, 1.0F)));
}

OkLab ok_lab(const Rgb& color) {
    return ok_lab_of({to_linear(color[0]), to_linear(color[1]), to_linear(color[2])});
}

bool is_shown(const Rgb& linear) {
    constexpr float slack = 1e-4F;
    return std::ranges::all_of(linear, [](float c) { return c >= -slack && c <= 1 + slack; });
}

// Returns the color with as much of its chroma as displays can show.
Rgb shown(const OkLab& color) {
    Rgb linear = linear_of(color);
    if (is_shown(linear)) return linear;
    float low = 0, high = 1;
    for (int step = 0; step < 7; ++step) {
        const float middle = 0.5F * (low + high);
        const Rgb tried = linear_of(OkLab{color.l, middle * color.a, middle * color.b});
        (is_shown(tried) ? low : high) = middle;
    }
    return linear_of(OkLab{color.l, low * color.a, low * color.b});
}

float lit_lightness(float l, float factor) {
    if (factor < 1) return l * std::max(darkest_share, 1 - strength * (1 - factor));
    return l + std::max(0.0F, lightest - l) * (1 - std::exp(-lightening * (factor - 1)));
}

Rgb color_at(const float* rgba) {
    const float whole = 1 / rgba[3];
    return {rgba[0] * whole, rgba[1] * whole, rgba[2] * whole};
}

}  // namespace

Rgb lit_color(const Rgb& color, float factor) {
    OkLab lab = ok_lab(color);
    const float l = lit_lightness(lab.l, factor);
    if (factor < 1) {
        const float chroma = lab.l > 0 ? std::sqrt(l / lab.l) : 1;
        lab.a *= chroma;
        lab.b *= chroma;
    }
    lab.l = l;
    const Rgb linear = shown(lab);
    return {to_srgb(linear[0]), to_srgb(linear[1]), to_srgb(linear[2])};
}

// Reads only every fifth pixel along both axes, and finds the exposure by halving its range.
float exposure_of(const Layer& layer, const std::vector<float>& light) {
    struct Seen {
        float l, factor, alpha;
    };
    std::vector<Seen> seen;
    for (int y = 0; y < layer.height; y += exposure_stride) {
        for (int x = 0; x < layer.width; x += exposure_stride) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) +
                               static_cast<std::size_t>(x);
            const float* rgba = layer.rgba.data() + 4 * pixel;
            if (rgba[3] < least_alpha) continue;
            seen.push_back({ok_lab(color_at(rgba)).l, light[pixel] / rgba[3], rgba[3]});
        }
    }
    if (seen.empty()) return 1;
    float low = least_exposure, high = most_exposure;
    for (int step = 0; step < exposure_steps; ++step) {
        const float middle = 0.5F * (low + high);
        double lighter = 0;
        for (const Seen& one : seen)
            lighter += static_cast<double>(one.alpha *
                                           (lit_lightness(one.l, middle * one.factor) - one.l));
        (lighter > 0 ? high : low) = middle;
    }
    return 0.5F * (low + high);
}

void apply_light(Layer& layer, const std::vector<float>& light, int threads) {
    const float exposure = exposure_of(layer, light);
    const auto width = static_cast<std::size_t>(layer.width);
    for_each_piece(layer.height, threads, [&](int y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
            float* rgba = layer.rgba.data() + 4 * pixel;
            const float alpha = rgba[3];
            if (alpha < least_alpha) continue;
            const Rgb lit = lit_color(color_at(rgba), exposure * light[pixel] / alpha);
            for (std::size_t c = 0; c < 3; ++c)
                rgba[c] = alpha * lit[c];
        }
    });
}

}  // namespace stormcellar::render

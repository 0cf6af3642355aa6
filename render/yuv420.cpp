#include "render/yuv420.h"

#include <algorithm>
#include <array>

namespace stormcellar::render {
namespace {

// BT.709 luma weights, and what follows from them, in units of 2^-18.
constexpr double red = 0.2126, green = 0.7152, blue = 0.0722;
constexpr int fixed_bits = 18;

constexpr std::int32_t fixed(double factor) {
    const double scaled = factor * (1 << fixed_bits);
    return static_cast<std::int32_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
}

constexpr double luma_scale = 219.0 / 255;
constexpr double chroma_scale = 224.0 / 255;
constexpr std::array<std::int32_t, 3> to_y = {fixed(luma_scale * red), fixed(luma_scale* green),
                                              fixed(luma_scale* blue)};
constexpr double per_u = chroma_scale / (2 * (1 - blue));
constexpr double per_v = chroma_scale / (2 * (1 - red));
constexpr std::array<std::int32_t, 3> to_u = {fixed(-per_u * red), fixed(-per_u* green),
                                              fixed(per_u*(1 - blue))};
constexpr std::array<std::int32_t, 3> to_v = {fixed(per_v * (1 - red)), fixed(-per_v* green),
                                              fixed(-per_v* blue)};

using Sum = std::array<std::int32_t, 3>;

// The scalar product, divided by 2^(18 + extra_bits), plus an offset.
std::uint8_t project(const std::array<std::int32_t, 3>& row, const Sum& rgb, int extra_bits,
                     std::int32_t offset) {
    const int bits = fixed_bits + extra_bits;
    std::int64_t sum = (std::int64_t{offset} << bits) + (std::int64_t{1} << (bits - 1));
    for (std::size_t c = 0; c < 3; ++c)
        sum += std::int64_t{row[c]} * rgb[c];
    return static_cast<std::uint8_t>(sum >> bits);
}

class Source {
  public:
    explicit Source(const Image& image) : image_(&image) {}
    // Beyond the edge the edge goes on.
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        const int column = std::clamp(x, 0, image_->width - 1);
        const int row = std::clamp(y, 0, image_->height - 1);
        return image_->rgba.data() +
               (static_cast<std::size_t>(row) * static_cast<std::size_t>(image_->width) +
                static_cast<std::size_t>(column)) *
                   4;
    }

  private:
    const Image* image_;
};

// 1-2-1 across times 1-1 down: eight times the mean.
Sum chroma_neighbourhood(const Source& source, int x, int y) {
    Sum sum{};
    for (int row = y; row < y + 2; ++row) {
        const std::uint8_t* left = source.at(x - 1, row);
        const std::uint8_t* middle = source.at(x, row);
        const std::uint8_t* right = source.at(x + 1, row);
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += left[c] + 2 * middle[c] + right[c];
    }
    return sum;
}

}  // namespace

Yuv420 to_yuv420(const Image& image) {
    Yuv420 out;
    out.width = image.width + image.width % 2;
    out.height = image.height + image.height % 2;
    const std::size_t pixels =
        static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    out.y.reserve(pixels);
    out.u.reserve(pixels / 4);
    out.v.reserve(pixels / 4);
    const Source source(image);
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            const std::uint8_t* rgb = source.at(x, y);
            out.y.push_back(project(to_y, {rgb[0], rgb[1], rgb[2]}, 0, 16));
        }
    }
    for (int y = 0; y < out.height; y += 2) {
        for (int x = 0; x < out.width; x += 2) {
            const Sum sum = chroma_neighbourhood(source, x, y);
            out.u.push_back(project(to_u, sum, 3, 128));
            out.v.push_back(project(to_v, sum, 3, 128));
        }
    }
    return out;
}

}  // namespace stormcellar::render

#include "render/slicer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "render/level_position.h"
#include "render/slice_mask.h"
#include "render/threads.h"
#include "render/transfer_function.h"

namespace stormcellar::render {
namespace {

constexpr float opaque_enough = 0.001F;  // a ray ends when less light than this comes through

constexpr float largest_alpha = 0.9999999F;  // whose logarithm is finite

// Where the cells of each row, column and level are; one entry more than cells, a copy of the
// last, so that the upper neighbour of the last cell is itself.
struct Offsets {
    std::vector<std::size_t> x, y, z;

    explicit Offsets(const grid::BrickView& view) {
        const grid::GridSpec& spec = *view.spec;
        for (int i = 0; i < spec.nx; ++i)
            x.push_back(view.offset_x(i));
        for (int i = 0; i < spec.ny; ++i)
            y.push_back(view.offset_y(i));
        for (int i = 0; i < spec.nz(); ++i)
            z.push_back(view.offset_z(i));
        x.push_back(x.back());
        y.push_back(y.back());
        z.push_back(z.back());
    }
};

// A ray in cell positions: position = start + t * step, t counting slices from the near end. The
// third axis is a level where levels have one spacing, else a height of drawn space. The ray is
// inside the box from `enter` to `leave`.
struct Ray {
    float x, y, z;
    float step_x, step_y, step_z;
    float enter, leave;
};

// What a ray finds at a point: a bin of the transfer function and the share of valued cells.
struct Sample {
    int bin = 0;
    float valued = 0;
};

struct Colour {
    float red = 0, green = 0, blue = 0, through = 1;
};

// One cell position on one axis: the lower cell and how far beyond it.
struct Between {
    std::size_t cell;
    float weight;
};

template <class Code, bool uniform_levels>
class RayCaster {
  public:
    RayCaster(const grid::BrickView& view, const ViewGeometry& geometry,
              const TransferFunction& transfer, int slices)
        : geometry_(geometry),
          slices_(slices),
          step_m_((geometry.far_m() - geometry.near_m()) / slices),
          spacing_m_(view.spec->spacing_m),
          first_x_m_(view.spec->x_m(0)),
          first_y_m_(view.spec->y_m(0)),
          top_x_(static_cast<float>(view.spec->nx - 1)),
          top_y_(static_cast<float>(view.spec->ny - 1)),
          top_z_(static_cast<float>(view.spec->nz() - 1)),
          levels_(*view.spec, geometry.exaggeration()),
          offsets_(view),
          codes_(view.codes.data()),
          transfer_(transfer) {}

    [[nodiscard]] Colour cast(Pixel pixel, const std::uint64_t* mask, std::size_t words) const {
        Colour colour;
        const Ray ray = make_ray(pixel);
        if (!(ray.enter < ray.leave)) return colour;
        const int first = static_cast<int>(ray.enter);
        Sample back;
        int last_done = -2;
        for (auto w = static_cast<std::size_t>(first) / 64; w < words; ++w) {
            for (std::uint64_t bits = mask[w]; bits != 0; bits &= bits - 1) {
                const int k = static_cast<int>(w) * 64 + std::countr_zero(bits);
                if (k < first) continue;
                const float from = std::max(static_cast<float>(k), ray.enter);
                const float to = std::min(static_cast<float>(k + 1), ray.leave);
                if (from >= to) return colour;
                const Sample front = k == last_done + 1 ? back : sample(ray, from);
                back = sample(ray, to);
                last_done = k;
                add_step(front, back, to - from, colour);
                if (colour.through < opaque_enough) return colour;
            }
        }
        return colour;
    }

  private:
    [[nodiscard]] Ray make_ray(Pixel pixel) const {
        const Vec3 start = geometry_.point(pixel, geometry_.near_m());
        const Vec3& forward = geometry_.forward();
        const Vec3 low = {-geometry_.half_x_m(), -geometry_.half_y_m(),
                          geometry_.bottom_m() * geometry_.exaggeration()};
        const Vec3 high = {geometry_.half_x_m(), geometry_.half_y_m(),
                           geometry_.top_m() * geometry_.exaggeration()};
        double first = 0;
        double last = slices_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double along = forward[axis] * step_m_;
            if (along == 0) {
                if (start[axis] < low[axis] || start[axis] > high[axis]) last = -1;
                continue;
            }
            const double a = (low[axis] - start[axis]) / along;
            const double b = (high[axis] - start[axis]) / along;
            first = std::max(first, std::min(a, b));
            last = std::min(last, std::max(a, b));
        }
        const double z_slope = uniform_levels ? levels_.slope() : 1;
        const double z_offset = uniform_levels ? levels_.offset() : 0;
        return {static_cast<float>((start[0] - first_x_m_) / spacing_m_),
                static_cast<float>((start[1] - first_y_m_) / spacing_m_),
                static_cast<float>(z_offset + start[2] * z_slope),
                static_cast<float>(forward[0] * step_m_ / spacing_m_),
                static_cast<float>(forward[1] * step_m_ / spacing_m_),
                static_cast<float>(forward[2] * step_m_ * z_slope),
                static_cast<float>(first),
                static_cast<float>(last)};
    }

    [[nodiscard]] static Between between(float position, float top) {
        const float inside = std::clamp(position, 0.0F, top);
        const auto cell = static_cast<std::uint32_t>(inside);
        return {cell, inside - static_cast<float>(cell)};
    }

    [[nodiscard]] std::uint32_t code(std::size_t offset) const {
        Code value;
        std::memcpy(&value, codes_ + offset * sizeof(Code), sizeof(Code));
        return value;
    }

    [[nodiscard]] Sample sample(const Ray& ray, float t) const {
        const float raw_z = ray.z + t * ray.step_z;
        const Between x = between(ray.x + t * ray.step_x, top_x_);
        const Between y = between(ray.y + t * ray.step_y, top_y_);
        const Between z = between(uniform_levels ? raw_z : levels_(raw_z), top_z_);

        const std::size_t z0 = offsets_.z[z.cell];
        const std::size_t z1 = offsets_.z[z.cell + 1];
        const std::size_t row0 = offsets_.x[x.cell] + offsets_.y[y.cell];
        const std::size_t row1 = offsets_.x[x.cell + 1] + offsets_.y[y.cell];
        const std::size_t row2 = offsets_.x[x.cell] + offsets_.y[y.cell + 1];
        const std::size_t row3 = offsets_.x[x.cell + 1] + offsets_.y[y.cell + 1];
        const std::uint32_t codes[8] = {code(row0 + z0), code(row1 + z0), code(row2 + z0),
                                        code(row3 + z0), code(row0 + z1), code(row1 + z1),
                                        code(row2 + z1), code(row3 + z1)};
        const std::uint32_t largest =
            std::max(std::max(std::max(codes[0], codes[1]), std::max(codes[2], codes[3])),
                     std::max(std::max(codes[4], codes[5]), std::max(codes[6], codes[7])));
        if (largest < grid::first_value_code) return {};

        const float x1 = x.weight;
        const float x0 = 1 - x1;
        const float corners[4] = {x0 * (1 - y.weight), x1 * (1 - y.weight), x0 * y.weight,
                                  x1 * y.weight};
        float sum = 0;
        float valued = 0;
        for (int i = 0; i < 8; ++i) {
            const float weight = corners[i & 3] * (i < 4 ? 1 - z.weight : z.weight);
            const float counts = codes[i] >= grid::first_value_code ? weight : 0.0F;
            valued += counts;
            sum += counts * static_cast<float>(codes[i]);
        }
        if (valued <= 0) return {};
        return {transfer_.bin(sum / valued), valued};
    }

    // The stretch between two samples; an end without a value takes that of the other.
    void add_step(const Sample& front, const Sample& back, float length, Colour& colour) const {
        if (front.valued + back.valued <= 0) return;
        const TransferEntry& entry = transfer_.entry(front.valued > 0 ? front.bin : back.bin,
                                                     back.valued > 0 ? back.bin : front.bin);
        float share = colour.through * 0.5F * (front.valued + back.valued);
        // Only where the ray enters and leaves the box: the opacity of a part of a step.
        if (length < 1 && entry.alpha > 0) {
            const float alpha = std::min(entry.alpha, largest_alpha);
            share *= -std::expm1(length * std::log1p(-alpha)) / alpha;
        }
        colour.red += share * entry.red;
        colour.green += share * entry.green;
        colour.blue += share * entry.blue;
        colour.through -= share * entry.alpha;
    }

    const ViewGeometry& geometry_;
    int slices_;
    double step_m_;
    double spacing_m_, first_x_m_, first_y_m_;
    float top_x_, top_y_, top_z_;
    LevelPosition levels_;
    Offsets offsets_;
    const std::byte* codes_;
    const TransferFunction& transfer_;
};

template <class Caster>
void cast_tile(const Caster& caster, int tile, int tile_row, const std::uint64_t* mask,
               std::size_t words, Layer& layer) {
    const int right = std::min((tile + 1) * tile_edge, layer.width);
    const int bottom = std::min((tile_row + 1) * tile_edge, layer.height);
    for (int y = tile_row * tile_edge; y < bottom; ++y) {
        for (int x = tile * tile_edge; x < right; ++x) {
            const Colour colour = caster.cast({x + 0.5, y + 0.5}, mask, words);
            float* pixel = layer.rgba.data() +
                           (static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) +
                            static_cast<std::size_t>(x)) *
                               4;
            pixel[0] = colour.red;
            pixel[1] = colour.green;
            pixel[2] = colour.blue;
            pixel[3] = 1 - colour.through;
        }
    }
}

template <class Caster>
void cast_all(const Caster& caster, const SliceMask& mask, int threads, Layer& layer) {
    for_each_piece(mask.tiles_down(), threads, [&](int tile_row) {
        std::vector<std::uint64_t> words;
        if (!mask.fill_band(tile_row, words)) return;
        const std::size_t per_tile = mask.words_per_tile();
        for (int tile = 0; tile < mask.tiles_across(); ++tile) {
            const std::uint64_t* bits = words.data() + static_cast<std::size_t>(tile) * per_tile;
            if (std::all_of(bits, bits + per_tile, [](std::uint64_t w) { return w == 0; })) {
                continue;
            }
            cast_tile(caster, tile, tile_row, bits, per_tile, layer);
        }
    });
}

std::uint8_t mixed(float front, float through, std::uint8_t back) {
    const float level = front * 255.0F + through * static_cast<float>(back);
    return static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
}

}  // namespace

Layer slice_volume(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
                   double opacity, int threads) {
    Layer layer{geometry.width(), geometry.height(), {}};
    layer.rgba.resize(static_cast<std::size_t>(layer.width) *
                      static_cast<std::size_t>(layer.height) * 4);
    const double step_m = (geometry.far_m() - geometry.near_m()) / slices;
    const TransferFunction transfer(view.quantization, opacity, step_m);
    const SliceMask mask(view, geometry, slices, transfer.first_visible_code());
    const bool uniform = LevelPosition(*view.spec, geometry.exaggeration()).is_uniform();
    const auto run = [&]<class Code, bool uniform_levels>() {
        const RayCaster<Code, uniform_levels> caster(view, geometry, transfer, slices);
        cast_all(caster, mask, threads, layer);
    };
    if (view.quantization.code_bytes == 1) {
        uniform ? run.template operator()<std::uint8_t, true>()
                : run.template operator()<std::uint8_t, false>();
    } else {
        uniform ? run.template operator()<std::uint16_t, true>()
                : run.template operator()<std::uint16_t, false>();
    }
    return layer;
}

void composite_over(const Layer& layer, Image& background, int left, int top) {
    for (int y = 0; y < layer.height; ++y) {
        const float* from = layer.rgba.data() +
                            static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) * 4;
        std::uint8_t* to =
            background.rgba.data() +
            (static_cast<std::size_t>(y + top) * static_cast<std::size_t>(background.width) +
             static_cast<std::size_t>(left)) *
                4;
        for (int x = 0; x < layer.width; ++x, from += 4, to += 4) {
            if (from[3] <= 0) continue;
            for (int c = 0; c < 3; ++c)
                to[c] = mixed(from[c], 1 - from[3], to[c]);
        }
    }
}

}  // namespace stormcellar::render

#include "render/volume/slicer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "render/volume/band_caster.h"
#include "render/volume/level_position.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {
namespace {

// The widest stride that leaves no cell between the first rays.
PixelSteps pixel_steps(const grid::GridSpec& spec, const ViewGeometry& geometry, double tolerance) {
    PixelSteps steps;
    if (!(tolerance > 0)) return steps;
    steps.tolerance = static_cast<float>(tolerance);
    const double cell_m = std::min(spec.cell_width_m(), spec.cell_height_m());
    const double pixel_m = geometry.metres_per_pixel(geometry.far_m());
    while (steps.stride < tile_edge && 2 * steps.stride * pixel_m <= cell_m)
        steps.stride *= 2;
    return steps;
}

std::uint8_t mixed(float front, float through, std::uint8_t back) {
    const float level = front * 255.0F + through * static_cast<float>(back);
    return static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
}

}  // namespace

VolumeSlicer::VolumeSlicer(const ColourTable& table, const grid::Quantization& quantization,
                           const ViewGeometry& geometry, const VolumeOptions& options)
    : geometry_(geometry),
      options_(options),
      transfer_(table, quantization, options.opacity, step_m(), options.integration) {}

double VolumeSlicer::step_m() const {
    return (geometry_.far_m() - geometry_.near_m()) / options_.slices;
}

// Surfaces are steep where values change by 4 steps of their codes a kilometre of drawn space: 2
// dB.
PacketLight VolumeSlicer::light_of(const grid::GridSpec& spec) const {
    PacketLight light;
    light.gradient = options_.light.gradient;
    const Vec3 sun = sun_direction(options_.light);
    const double levels = std::max(1, spec.nz() - 1);
    const double level_m = (spec.levels_m.back() - spec.levels_m.front()) / levels;
    const Vec3 cell_m = {spec.cell_width_m(), spec.cell_height_m(),
                         std::max(level_m, 1.0) * geometry_.exaggeration()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        light.sun[axis] = static_cast<float>(sun[axis]);
        light.per_cell[axis] = static_cast<float>(1 / cell_m[axis]);
    }
    light.half_steep = 4e-3F;
    return light;
}

Layer VolumeSlicer::draw(const grid::BrickView& view, int threads) const {
    SlicerRoom room;
    draw(view, threads, room);
    return std::move(room.layer);
}

void VolumeSlicer::draw(const grid::BrickView& view, int threads, SlicerRoom& room) const {
    Layer& layer = room.layer;
    layer.width = geometry_.width();
    layer.height = geometry_.height();
    layer.rgba.assign(
        static_cast<std::size_t>(layer.width) * static_cast<std::size_t>(layer.height) * 4, 0.0F);
    const LevelPosition levels(*view.spec, geometry_.exaggeration());
    const RayMaker maker(*view.spec, geometry_, levels, options_.slices);
    PacketVolume volume(view, levels, transfer_);
    volume.curve = maker.curve();
    const double samples = 1.0 * layer.width * layer.height * options_.slices;
    if (CornerTable::serves(view, samples)) {
        room.corners.fill(view, threads);
        volume.use(room.corners);
    }
    std::optional<LightVolume> shadows;
    if (options_.light.needs_volume()) {
        shadows.emplace(view, transfer_, step_m(), geometry_, options_.light, threads);
    }
    PacketLight light = light_of(*view.spec);
    light.volume = shadows ? &*shadows : nullptr;
    if (options_.light.any()) volume.light = &light;
    const SliceMask mask(view, geometry_, options_.slices, transfer_, threads);
    const BandCaster caster(volume, maker, mask, layer.width, layer.height, layer.rgba.data());
    const PixelSteps steps = pixel_steps(*view.spec, geometry_, options_.pixel_tolerance);
    for_each_piece(mask.tiles_down(), threads,
                   [&](int tile_row) { caster.cast_first(tile_row, steps.stride); });
    for (int stride = steps.stride; stride > 1; stride /= 2) {
        for_each_piece(mask.tiles_down(), threads,
                       [&](int tile_row) { caster.refine(tile_row, stride, steps.tolerance); });
    }
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

#include "render/volume/slicer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "render/volume/band_caster.h"
#include "render/volume/level_position.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {
namespace {

// Returns the widest stride that leaves no cell between the first rays.
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

}  // namespace

VolumeSlicer::VolumeSlicer(const ColourTable& table, const grid::Quantization& quantization,
                           const ViewGeometry& geometry, const VolumeOptions& options,
                           TransferCache* keeper)
    : geometry_(geometry), options_(options) {
    TransferCache own;
    transfer_ = (keeper != nullptr ? *keeper : own)
                    .get(table, quantization, options.opacity, step_m(), options.integration);
}

double VolumeSlicer::step_m() const {
    return (geometry_.far_m() - geometry_.near_m()) / options_.slices;
}

// Prepares the light. A surface is steep if values change by 4 steps of their codes (2 dB) for each
// kilometer of drawn space.
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
    prepare(view, threads, room);
    cast(view, threads, room);
    return std::move(room.layer);
}

// Prepares what the rays need: the mask of steps that may show anything, the light in the volume if
// the scene asks for shadows, and the table of corners if there are enough samples for each cell.
void VolumeSlicer::prepare(const grid::BrickView& view, int threads, SlicerRoom& room) const {
    Layer& layer = room.layer;
    layer.width = geometry_.width();
    layer.height = geometry_.height();
    layer.rgba.resize(static_cast<std::size_t>(layer.width) *
                      static_cast<std::size_t>(layer.height) * 4);
    // Where the picture is interpolated between rays, about half of the rays are cast.
    const bool all_rays = pixel_steps(*view.spec, geometry_, options_.pixel_tolerance).stride == 1;
    room.mask.emplace(view, geometry_, options_.slices, *transfer_, threads,
                      all_rays ? small_tile_edge : tile_edge);
    room.shadows.reset();
    if (options_.light.needs_volume()) {
        room.shadows.emplace(view, *transfer_, step_m(), geometry_, options_.light, threads);
    }
    const double rays = (all_rays ? 1.0 : 0.5) * layer.width * layer.height;
    const double samples = rays * options_.slices;
    room.has_corners = CornerTable::serves(view, samples);
    if (room.has_corners) room.corners.fill(view, threads);
}

// Casts the rays, one band of tiles after another on several threads: first those on a grid of
// `stride` pixels, then, halving the stride each time, those where the picture is not smooth enough
// to be interpolated.
void VolumeSlicer::cast(const grid::BrickView& view, int threads, SlicerRoom& room) const {
    const LevelPosition levels(*view.spec, geometry_.exaggeration());
    const RayMaker maker(*view.spec, geometry_, levels, options_.slices);
    PacketVolume volume(view, levels, *transfer_);
    volume.curve = maker.curve();
    if (room.has_corners) volume.use(room.corners);
    PacketLight light = light_of(*view.spec);
    light.volume = room.shadows ? &*room.shadows : nullptr;
    if (options_.light.any()) volume.light = &light;
    Layer& layer = room.layer;
    const BandCaster caster(volume, maker, *room.mask, layer.width, layer.height,
                            layer.rgba.data());
    const PixelSteps steps = pixel_steps(*view.spec, geometry_, options_.pixel_tolerance);
    const int bands = room.mask->tiles_down();
    for_each_piece(bands, threads,
                   [&](int tile_row) { caster.cast_first(tile_row, steps.stride); });
    for (int stride = steps.stride; stride > 1; stride /= 2) {
        for_each_piece(bands, threads,
                       [&](int tile_row) { caster.refine(tile_row, stride, steps.tolerance); });
    }
}

}  // namespace stormcellar::render

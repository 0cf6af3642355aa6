#include "render/volume/slicer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "render/volume/band_caster.h"
#include "render/volume/level_position.h"
#include "render/volume/light_volume.h"
#include "render/volume/lit_layer.h"
#include "render/volume/transfer_function.h"

namespace stormcellar::render {
namespace {

// Returns the widest stride for which the first rays miss no cell.
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

VolumeSlicer::VolumeSlicer(const ColorTable& table, const grid::Quantization& quantization,
                           const ViewGeometry& geometry, const VolumeOptions& options,
                           TransferCache* cache, int threads)
    : geometry_(geometry), table_(table), options_(options) {
    TransferCache own;
    transfer_ =
        (cache != nullptr ? *cache : own)
            .get(table, quantization, options.opacity, step_m(), options.integration, threads);
}

double VolumeSlicer::step_m() const {
    return (geometry_.far_m() - geometry_.near_m()) / options_.slices;
}

Layer VolumeSlicer::draw(const grid::BrickView& view, int threads) const {
    SlicerRoom room;
    prepare(view, threads, room);
    cast(view, threads, room);
    return std::move(room.layer);
}

// Prepares the tables that the rays need: the mask of steps that may show anything, the light in
// the volume if the scene is lit, and the table of corners if there are enough samples for each
// cell.
void VolumeSlicer::prepare(const grid::BrickView& view, int threads, SlicerRoom& room) const {
    Layer& layer = room.layer;
    layer.width = geometry_.width();
    layer.height = geometry_.height();
    layer.rgba.resize(static_cast<std::size_t>(layer.width) *
                      static_cast<std::size_t>(layer.height) * 4);
    // If pixels between rays are interpolated, about half of the rays are cast.
    const bool all_rays = pixel_steps(*view.spec, geometry_, options_.pixel_tolerance).stride == 1;
    room.mask.emplace(view, geometry_, options_.slices, *transfer_, threads,
                      all_rays ? small_tile_edge : tile_edge);
    room.shades.reset();
    if (options_.light.any()) {
        std::optional<LightVolume> through;
        if (options_.light.needs_volume()) {
            through.emplace(view, *transfer_, step_m(), geometry_, options_.light, threads);
        }
        room.shades.emplace(view, table_, geometry_, options_.light, through ? &*through : nullptr,
                            threads);
        room.light.resize(layer.rgba.size() / 4);
    }
    const double rays = (all_rays ? 1.0 : 0.5) * layer.width * layer.height;
    const double samples = rays * options_.slices;
    room.has_corners = CornerTable::serves(view, samples);
    if (room.has_corners) room.corners.fill(view, threads);
}

// Casts the rays, one band of tiles after another, on several threads. First casts the rays of a
// grid of `stride` pixels. Then halves the stride again and again, and casts only rays at which the
// picture is not smooth enough for interpolation.
void VolumeSlicer::cast(const grid::BrickView& view, int threads, SlicerRoom& room) const {
    const LevelPosition levels(*view.spec, geometry_.exaggeration());
    const RayMaker maker(*view.spec, geometry_, levels, options_.slices);
    PacketVolume volume(view, levels, *transfer_);
    volume.curve = maker.curve();
    if (room.has_corners) volume.use(room.corners);
    const PacketLight light = room.shades ? PacketLight(*room.shades) : PacketLight();
    if (room.shades) volume.light = &light;
    Layer& layer = room.layer;
    const BandCaster caster(volume, maker, *room.mask, layer.width, layer.height, layer.rgba.data(),
                            room.shades ? room.light.data() : nullptr);
    const PixelSteps steps = pixel_steps(*view.spec, geometry_, options_.pixel_tolerance);
    const int bands = room.mask->tiles_down();
    for_each_piece(bands, threads,
                   [&](int tile_row) { caster.cast_first(tile_row, steps.stride); });
    for (int stride = steps.stride; stride > 1; stride /= 2) {
        for_each_piece(bands, threads,
                       [&](int tile_row) { caster.refine(tile_row, stride, steps.tolerance); });
    }
    if (room.shades) apply_light(layer, room.light, threads);
}

}  // namespace stormcellar::render

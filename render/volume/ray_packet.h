// render/volume/ray_packet.h -- sixteen rays through the volume: the slicer's inner loop.
//
// SIMD by Highway, the target chosen at run time. No operation is fused or reordered, so that every
// target gives the same bits. What a ray does is said in render/volume/slicer.h.
// Thread contract: plain data; cast_packet() may run on many threads.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/volume/corner_table.h"
#include "render/volume/level_position.h"
#include "render/volume/light_volume.h"
#include "render/volume/transfer_function.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {

inline constexpr int packet_rays = 16;

// The earth's curve in cell positions.
struct CurvedLevels {
    float curve_x = 0, curve_y = 0, middle_x = 0, middle_y = 0;
};

// How samples are lit (stormcellar/render/light.h).
struct PacketLight {
    const LightVolume* volume = nullptr;  // none: no shadows
    bool gradient = false;
    float sun[3] = {};       // towards it, of unit length
    float per_cell[3] = {};  // 1 / metres between neighbouring cells of drawn space
    float half_steep = 1;    // codes a metre at which a surface is half as dark as it may be
};

struct PacketVolume {
    const std::byte* codes = nullptr;
    int code_bytes = 1;
    std::int32_t brick_stride_x = 0, brick_stride_y = 0;  // codes from brick to brick
    const std::byte* words = nullptr;  // of a CornerTable; none: the bricks serve
    std::int32_t word_stride_x = 0, word_stride_y = 0;
    std::int32_t last_x = 0, last_y = 0, last_z = 0;  // cells
    const LevelPosition* levels = nullptr;            // none: z of a ray is a level
    const TransferFunction* transfer = nullptr;
    const CurvedLevels* curve = nullptr;  // none: the earth is flat
    const PacketLight* light = nullptr;   // none: the table's own colours

    // `levels` and `transfer` must outlive this.
    PacketVolume(const grid::BrickView& view, const LevelPosition& levels,
                 const TransferFunction& transfer);
    // From here on codes are taken from the table, which must outlive this.
    void use(const CornerTable& table);
    // Whether every code of the view has a number that fits.
    [[nodiscard]] static bool can_address(const grid::BrickView& view);
};

// Rays in cell positions: position = start + t * step, t counting slices from the near end. The
// third axis is a level, or with PacketVolume::levels a height of drawn space; with a curved earth
// it is lower by curve_x * (x - middle_x)^2 + curve_y * (y - middle_y)^2 than what it stands for.
// Ray i is inside the box from enter[i] to leave[i]; with enter >= leave it sees nothing.
struct RayPacket {
    float x[packet_rays], y[packet_rays], z[packet_rays];
    float step_x[packet_rays], step_y[packet_rays], step_z[packet_rays];
    float length[packet_rays];  // of a step, in reference steps of the transfer function
    float enter[packet_rays], leave[packet_rays];
};

// Red, green, blue (premultiplied) and alpha of each ray. Only steps whose bit is set are sampled.
void cast_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                 std::size_t words, float* rgba);

}  // namespace stormcellar::render

// render/volume/ray_packet.h -- casts sixteen rays through the volume: the slicer's inner loop.
//
// The loop uses SIMD by Highway, with a target that is chosen at run time. No operation is fused or
// reordered, so every target gives the same bits. render/volume/slicer.h tells what a ray does.
//
// Threads   Plain data; many threads may call cast_packet().
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/volume/corner_table.h"
#include "render/volume/level_position.h"
#include "render/volume/shade_field.h"
#include "render/volume/transfer_function.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {

inline constexpr int packet_rays = 16;

// The curve of the earth in positions of cells.
struct CurvedLevels {
    float curve_x = 0, curve_y = 0, middle_x = 0, middle_y = 0;
};

// The light in the volume: the words of a ShadeField.
struct PacketLight {
    const std::byte* words = nullptr;
    std::int32_t stride_x = 0, stride_y = 0;
    std::int32_t last_x = 0, last_y = 0, last_z = 0;  // coarse cells

    PacketLight() = default;
    // The field must outlive the object.
    explicit PacketLight(const ShadeField& field);
};

struct PacketVolume {
    const std::byte* codes = nullptr;
    int code_bytes = 1;
    std::int32_t last_state = 2;                          // the highest code that means a state
    std::int32_t brick_stride_x = 0, brick_stride_y = 0;  // codes from brick to brick
    const std::byte* words = nullptr;  // of a CornerTable; null: codes come from the bricks
    std::int32_t word_stride_x = 0, word_stride_y = 0;
    std::int32_t last_x = 0, last_y = 0, last_z = 0;  // cells
    const LevelPosition* levels = nullptr;            // null: z of a ray is a level
    const TransferFunction* transfer = nullptr;
    const CurvedLevels* curve = nullptr;  // null: the earth is flat
    const PacketLight* light = nullptr;   // null: no light is found

    // `levels` and `transfer` must outlive the object.
    PacketVolume(const grid::BrickView& view, const LevelPosition& levels,
                 const TransferFunction& transfer);
    // Makes the volume take codes from the table, which must outlive it.
    void use(const CornerTable& table);
    // Returns true if a 32-bit number can address every code of the view.
    [[nodiscard]] static bool can_address(const grid::BrickView& view);
};

// Rays in positions of cells: position = start + t * step, where t counts slices from the near end.
// The third axis is a level, or, with PacketVolume::levels, a height of drawn space. On a curved
// earth, the third axis plus curve_x * (x - middle_x)^2 + curve_y * (y - middle_y)^2 is that level
// or height. Ray i is inside the box from enter[i] to leave[i]; if enter >= leave, it sees nothing.
struct RayPacket {
    float x[packet_rays], y[packet_rays], z[packet_rays];
    float step_x[packet_rays], step_y[packet_rays], step_z[packet_rays];
    float length[packet_rays];  // of a step, in reference steps of the transfer function
    float enter[packet_rays], leave[packet_rays];
};

// Computes red, green, blue (premultiplied) and alpha of each ray. Samples only the steps whose bit
// is set. If the volume has a light, also computes the sum of the light factors along the ray,
// weighted by the seen opacity; otherwise `light` is not used.
void cast_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                 std::size_t words, float* rgba, float* light);

}  // namespace stormcellar::render

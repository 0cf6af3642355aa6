// render/volume/slicer.h -- draws the volume as slices parallel to the picture, and composites them
// from front to back.
//
// The depth of the grid's box is divided into `slices` equal steps. Every ray samples the volume at
// the planes between these steps, and at the points at which it enters and leaves the box.
//   sample   Trilinear: the weighted mean of the values of those of the 8 cells around the point
//            that have a value. The share of the sample is the sum of the weights of these cells.
//            So echo tapers to nothing over one cell toward cells without a value, whatever their
//            state, and no state ever adds a color. The outermost cells continue up to half a cell
//            beyond their centers.
//   step     The entry of the TransferFunction for the values at its two ends. The optical depth of
//            the entry is multiplied by the mean of the shares at the two ends, and by the length
//            of the ray through the step, which may be cut by the box. If one end has no value, the
//            value of the other end is used for both. Colors mix in sRGB, as drawn.
//   light    If the scene asks for it, a step has the factor (stormcellar/render/light.h) of
//            the slice at its ends that has an even number. Two steps share this slice.
//   skipped  Parts of a ray in bricks whose range of values is clear (this is exact), and
//            everything behind an opacity of 0.999 (this changes no channel by more than 0.26 of
//            255).
//
// Accuracy  docs/rendering.md has the measured order of convergence of each Integration. The oracle
//           is render/volume/reference_marcher.h. The same bits for any number of threads.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/image/layer.h"
#include "render/volume/corner_table.h"
#include "render/volume/ray_packet.h"
#include "render/volume/shade_field.h"
#include "render/volume/slice_mask.h"
#include "render/volume/transfer_cache.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/light.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// The memory in which a picture is drawn. A caller that keeps it for the next picture need not
// allocate it again.
struct SlicerRoom {
    Layer layer;  // of the last picture
    std::optional<SliceMask> mask;
    std::optional<ShadeField> shades;
    std::vector<float> light;  // of each pixel, if the scene is lit
    bool has_corners = false;
    CornerTable corners;
};

struct VolumeOptions {
    int slices = 256;  // at least 1
    Integration integration = Integration::second_order;
    double opacity = 1;  // scales the table's extinction; above 0
    // If cells are larger than pixels, pixels between rays are interpolated if the expected error
    // of each channel is at most this (0..1). 0: a ray for each pixel.
    double pixel_tolerance = 0;
    Light light = {};  // none: the table's own colors
};

// Draws grids of one quantization in one view, and makes only once the tables that the grids share.
// A VolumeSlicer is immutable; many threads may call draw().
class VolumeSlicer {
  public:
    // The geometry must outlive this object. `cache` may be null. `threads` threads make the shared
    // tables.
    VolumeSlicer(const ColorTable& table, const grid::Quantization& quantization,
                 const ViewGeometry& geometry, const VolumeOptions& options,
                 TransferCache* cache = nullptr, int threads = 1);

    // Draws a grid, which must have the geometry's spec.
    [[nodiscard]] Layer draw(const grid::BrickView& view, int threads) const;
    // Draw the picture of draw() in two steps, into memory that no other thread uses: prepare()
    // makes the tables for a grid, and cast() casts the rays.
    void prepare(const grid::BrickView& view, int threads, SlicerRoom& room) const;
    void cast(const grid::BrickView& view, int threads, SlicerRoom& room) const;

  private:
    [[nodiscard]] double step_m() const;

    const ViewGeometry& geometry_;
    ColorTable table_;
    VolumeOptions options_;
    std::shared_ptr<const TransferFunction> transfer_;
};

}  // namespace stormcellar::render

// render/volume/slicer.h -- the volume as slices parallel to the picture, composited front to back.
//
// The depth of the grid's box is divided into `slices` equal steps; every ray samples the volume
// at the planes between them and where it enters and leaves the box.
//   sample   trilinear over the 8 cells round it, of which only those with a value count: the value
//            is their weighted mean, and the sum of their weights is the sample's share. So echo
//            tapers to nothing over one cell towards cells without a value, whatever their state,
//            and no state ever lends a colour. Half a cell beyond the outermost cell centres the
//            value is that of the cell.
//   step     the TransferFunction's entry for the values at its two ends; its optical depth is
//            multiplied by the mean of their shares and by the length of the ray's way through it,
//            where the box cuts the step too. An end without any value takes that of the other.
//            Colours mix in sRGB, as drawn.
//   light    where it is asked for: one factor a sample (stormcellar/render/light.h), the mean of
//   both
//            ends of a step
//   skipped  stretches of a ray in bricks whose range of values is clear (exact), and what lies
//            behind an opacity of 0.999 (changes no channel by more than 0.26 of 255).
// Accuracy: docs/rendering.md has the measured order of convergence of each Integration; the
// oracle is render/volume/reference_marcher.h. The same bits for any number of threads.
#pragma once

#include <memory>
#include <optional>

#include "render/image/layer.h"
#include "render/volume/corner_table.h"
#include "render/volume/light_volume.h"
#include "render/volume/ray_packet.h"
#include "render/volume/slice_mask.h"
#include "render/volume/transfer_cache.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/colour_table.h"
#include "stormcellar/render/light.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// A picture while it is drawn. Kept from picture to picture, it need not be asked for again.
struct SlicerRoom {
    Layer layer;  // of the last picture
    std::optional<SliceMask> mask;
    std::optional<LightVolume> shadows;
    bool has_corners = false;
    CornerTable corners;
};

struct VolumeOptions {
    int slices = 256;  // at least 1
    Integration integration = Integration::second_order;
    double opacity = 1;  // scales the table's extinction; above 0
    // Where cells are larger than pixels: between rays whose channels differ by no more than this
    // (of 1) the picture is interpolated. 0: a ray for each pixel.
    double pixel_tolerance = 0;
    Light light = {};  // none: the table's own colours
};

// Draws grids of one quantisation in one view: what they share is made once.
// Thread contract: immutable; draw() may run on many threads.
class VolumeSlicer {
  public:
    // The geometry must outlive this; `cache` may be null.
    VolumeSlicer(const ColourTable& table, const grid::Quantization& quantization,
                 const ViewGeometry& geometry, const VolumeOptions& options,
                 TransferCache* cache = nullptr);

    // Of the geometry's grid.
    [[nodiscard]] Layer draw(const grid::BrickView& view, int threads) const;
    // The same in two steps, into a room that no other draws in: what the rays need of a grid, and
    // the rays.
    void prepare(const grid::BrickView& view, int threads, SlicerRoom& room) const;
    void cast(const grid::BrickView& view, int threads, SlicerRoom& room) const;

  private:
    [[nodiscard]] double step_m() const;
    [[nodiscard]] PacketLight light_of(const grid::GridSpec& spec) const;

    const ViewGeometry& geometry_;
    VolumeOptions options_;
    std::shared_ptr<const TransferFunction> transfer_;
};

}  // namespace stormcellar::render

// render/map/map_ground.h -- converts between places on the earth and the ground of the picture, in
// meters.
//
// The ground is the plane of the grid's projection. Its origin is the middle of the grid, as in
// ViewGeometry.
//
// Accuracy  1e-7 m, as in stormcellar/grid/projection.h.
// Threads   Immutable.
#pragma once

#include "stormcellar/grid/projection.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

class GroundMap {
  public:
    // The spec must be valid and must outlive the map.
    explicit GroundMap(const grid::GridSpec& spec) : spec_(&spec), projection_(spec) {}

    [[nodiscard]] GroundPoint ground(grid::GeoPoint place) const {
        const grid::ColumnPoint column = projection_.to_column(place);
        return {(column.x - 0.5 * (spec_->nx - 1)) * spec_->cell_width_m(),
                (column.y - 0.5 * (spec_->ny - 1)) * spec_->cell_height_m()};
    }
    [[nodiscard]] grid::GeoPoint place(GroundPoint ground) const {
        return projection_.to_geo({ground.x_m / spec_->cell_width_m() + 0.5 * (spec_->nx - 1),
                                   ground.y_m / spec_->cell_height_m() + 0.5 * (spec_->ny - 1)});
    }
    [[nodiscard]] const grid::GridSpec& spec() const { return *spec_; }
    [[nodiscard]] const grid::GridProjection& projection() const { return projection_; }

  private:
    const grid::GridSpec* spec_;
    grid::GridProjection projection_;
};

}  // namespace stormcellar::render

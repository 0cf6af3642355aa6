// stormcellar/grid/column_geometry.h -- azimuth and arc from one site to every column of a grid
// spec.
//
// A ColumnGeometry is costly to make, so volumes and threads share one.
//
// Units     Degrees clockwise from north; meters along the earth.
// Threads   Immutable; many threads may use one object.
// Errors    See make_column_geometry().
// Accuracy  Enforced by tests/grid/column_geometry_test.cpp. The arc is within 0.02 m up to 500 km.
//           The azimuth is within 2e-5 degrees, plus the angle under which the site sees an error
//           of 1e-3 m (`table`) or 1e-6 m (`geodesic`), which matters only close to the site.
//           stormcellar/grid/frame_ladder.h has the bounds in meters, and the bounds of `sphere`.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/frame_ladder.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/tile.h"

namespace stormcellar::grid {

// The place of a column as seen from the site.
struct ColumnPlace {
    float azimuth_deg = 0;  // [0, 360)
    float arc_m = 0;
};

class ColumnGeometry {
  public:
    // The spec must be valid and the site must be on the earth; make_column_geometry() checks this.
    ColumnGeometry(SitePosition site, GridSpec spec, ChosenFrame kind);

    [[nodiscard]] const SitePosition& site() const { return site_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    [[nodiscard]] FrameKind frame_kind() const { return kind_; }
    // Returns the columns of a row, from west to east.
    [[nodiscard]] std::span<const ColumnPlace> row(int iy) const {
        const auto width = static_cast<std::size_t>(spec_.nx);
        return std::span(places_).subspan(static_cast<std::size_t>(iy) * width, width);
    }
    // Returns the tiles of columns, row by row.
    [[nodiscard]] std::span<const Tile> tiles() const { return tiles_; }

  private:
    void fill_centered();
    void fill_by_geodesics();
    void fill_on_sphere();
    void fill_from_table();

    SitePosition site_;
    GridSpec spec_;
    ChosenFrame kind_;
    std::vector<ColumnPlace> places_;
    std::vector<Tile> tiles_;
};

// Computes azimuth and arc from one site to every column of a spec. Errors: bad_argument for an
// invalid spec or a site that is not on the earth.
[[nodiscard]] Result<std::shared_ptr<const ColumnGeometry>> make_column_geometry(
    const SitePosition& site, const GridSpec& spec, ChosenFrame kind = {});

}  // namespace stormcellar::grid

// grid/column_geometry.h -- azimuth and arc from one site to every column of a grid spec.
//
// Made by make_column_geometry() (grid/gridder.h), immutable, shared between volumes and threads.
// Accuracy: azimuth 2e-5 deg and arc 0.02 m within 500 km (floats of exact geodesics); enforced by
// tests/grid/column_geometry_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "grid/grid.h"

namespace stormcellar::grid {

// As seen from the site.
struct ColumnPlace {
    float azimuth_deg = 0;  // [0, 360)
    float arc_m = 0;
};

class ColumnGeometry {
  public:
    // The spec must be valid and the site on the earth: make_column_geometry() checks.
    ColumnGeometry(SitePosition site, GridSpec spec);

    [[nodiscard]] const SitePosition& site() const { return site_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    // The columns of a row, west to east.
    [[nodiscard]] std::span<const ColumnPlace> row(int iy) const {
        const auto width = static_cast<std::size_t>(spec_.nx);
        return std::span(places_).subspan(static_cast<std::size_t>(iy) * width, width);
    }

  private:
    SitePosition site_;
    GridSpec spec_;
    std::vector<ColumnPlace> places_;
};

// Latitude and longitude of a column's centre.
struct GeoPoint;
[[nodiscard]] GeoPoint column_position(const GridSpec& spec, int ix, int iy);

}  // namespace stormcellar::grid

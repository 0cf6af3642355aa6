// stormcellar/grid/frame_ladder.h -- the rungs of the site frame: how to find azimuth and arc from
// a site, and how far off each rung may put a column.
//
// A column has a true place (by geodesics of WGS84), and a place that its azimuth and arc in a
// ColumnGeometry give. The error of the column is the distance between the two, in the azimuthal
// equidistant plane about the site.
//
// tests/grid/frame_ladder_test.cpp enforces each of these bounds, for grids all around their site,
// sites from pole to pole and reaches of 15 to 450 km. It checks that no error exceeds the bound,
// and that the bound is at most twice the largest error.
//   storage   Azimuth and arc are floats, so they are off by half a unit in their last place: 0.13
//             m at 470 km (for azimuths of 256 degrees and more). Every rung has this error.
//   geodesic  1e-6 m and storage.
//   table     1e-3 m and storage. Polynomials pass through exact geodesics at their nodes and are
//             checked where their error peaks. Where they cannot keep the bound, the geodesic is
//             solved exactly (grid/place/frame_table.h).
//   sphere    The largest error in scale of the sphere, integrated along the arc (see
//             docs/geometry.md): 239 / 573 / 1226 m at 100 / 230 / 460 km and 35 N.
// If the grid's projection is azimuthal equidistant about the site itself, every rung uses a closed
// form, and storage is the only error.
//
// Units     Meters and degrees.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstdint>
#include <string_view>

#include "stormcellar/grid/chosen.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

// The rungs, from coarse to exact. The table is the cheapest, except for grids of a few hundred
// columns.
enum class FrameKind : std::uint8_t {
    sphere,    // great circles of a sphere of 6371 km
    table,     // polynomials through exact geodesics
    geodesic,  // one exact geodesic for each column
};
using ChosenFrame = Chosen<FrameKind::table, FrameKind::sphere>;
[[nodiscard]] std::string_view frame_kind_name(FrameKind kind);

// Returns true if the plane of the grid is the plane about the site.
[[nodiscard]] bool is_centered_at(const SitePosition& site, const GridSpec& spec);

// Returns a distance from the site that no column exceeds: at most 2 % beyond the farthest column,
// or half the earth.
[[nodiscard]] double reach_m(const SitePosition& site, const GridSpec& spec);

// These return bounds on the error in meters, as listed above, for columns with arcs of at most
// `reach_m`.
[[nodiscard]] double storage_error_bound_m(double reach_m) noexcept;
[[nodiscard]] double sphere_error_bound_m(double site_latitude_deg, double reach_m) noexcept;
// Returns a bound on the whole error of the rung, including storage. For a radar, pass the lesser
// of reach_m() and the radar's range.
[[nodiscard]] double frame_error_bound_m(FrameKind kind, double site_latitude_deg,
                                         double reach_m) noexcept;
// Returns a bound on the whole error of the rung for all columns of a grid, as seen from the site.
[[nodiscard]] double frame_error_bound_m(FrameKind kind, const SitePosition& site,
                                         const GridSpec& spec);

}  // namespace stormcellar::grid

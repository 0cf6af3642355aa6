// stormcellar/grid/frame_ladder.h -- the rungs of the site frame: how azimuth and arc from a site
// are found, and how far off each rung may put a column.
//
// The error of a column is the distance, in the azimuthal equidistant plane about the site, between
// its true place (geodesics of WGS84) and the azimuth and arc that a ColumnGeometry keeps.
// Bounds (each enforced by tests/grid/frame_ladder_test.cpp, to be held and to be at most twice the
// largest error for grids all round their site: sites from pole to pole, 15 to 450 km)
//   storage   azimuth and arc are floats: half a unit in their last places, 0.13 m at 470 km (in
//             azimuths of 256 degrees and more). Every rung has it.
//   geodesic  1e-6 m and storage.
//   table     1e-3 m and storage: exact geodesics at the nodes of polynomials, which are checked
//             where their error peaks; what they cannot hold is solved exactly (frame_table.h).
//   sphere    the integral along the arc of the sphere's largest error in scale, see
//             docs/geometry.md; 239 / 573 / 1226 m at 100 / 230 / 460 km and 35 N.
// A grid in the azimuthal equidistant projection about the site itself is in closed form on every
// rung and has the error of storage alone.
// Thread contract: pure functions.
#pragma once

#include <cstdint>
#include <string_view>

#include "stormcellar/grid/chosen.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

// From coarse to exact. The table is the cheapest too, but for grids of a few hundred columns
// (docs/geometry.md).
enum class FrameKind : std::uint8_t {
    sphere,    // great circles of a sphere of 6371 km
    table,     // polynomials through exact geodesics
    geodesic,  // one exact geodesic for each column
};
using ChosenFrame = Chosen<FrameKind::table, FrameKind::sphere>;
[[nodiscard]] std::string_view frame_kind_name(FrameKind kind);

// Whether the plane of the grid is the plane about the site.
[[nodiscard]] bool is_centered_at(const SitePosition& site, const GridSpec& spec);

// No column is farther from the site than this: within 2 % of the farthest, or half the earth.
[[nodiscard]] double reach_m(const SitePosition& site, const GridSpec& spec);

// Bounds on the error in metres of all columns whose arc is at most `reach_m`, as listed above.
[[nodiscard]] double storage_error_bound_m(double reach_m) noexcept;
[[nodiscard]] double sphere_error_bound_m(double site_latitude_deg, double reach_m) noexcept;
// The rung's whole error, storage included. For a radar give the lesser of reach_m() and its range.
[[nodiscard]] double frame_error_bound_m(FrameKind kind, double site_latitude_deg,
                                         double reach_m) noexcept;
// The same for a grid of a site, over all its columns.
[[nodiscard]] double frame_error_bound_m(FrameKind kind, const SitePosition& site,
                                         const GridSpec& spec);

}  // namespace stormcellar::grid

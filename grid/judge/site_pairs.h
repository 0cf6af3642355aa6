// grid/judge/site_pairs.h -- cells of one site's grid, and where another site's faults would show
// them.
//
// Inside grid/judge/site_comparison.cpp only, whose header says which cells are taken.
// Units   columns of B's grid, metres up, degrees, seconds.
// Threads pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/judge/site_comparison.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {

// Of a place in B's grid: columns, and metres up.
struct SiteShift {
    double x = 0;
    double y = 0;
    double up_m = 0;
};

// A cell of A, and how B's faults move the place where B shows the same.
struct SitePair {
    double a_dbz = 0;
    ColumnPoint column;  // in B's grid, where nothing is at fault
    double height_m = 0;
    SiteShift by_azimuth, by_elevation, by_time;  // a degree, a degree, a second
    double apart_s = 0;                           // how much later B looked
    std::uint32_t block = 0;
};

[[nodiscard]] inline ColumnPoint moved(ColumnPoint column, const SiteShift& shift, double times) {
    return {column.x + shift.x * times, column.y + shift.y * times};
}

// Cells of A that have a value, columns brick by brick, each from the bottom up; B need not have
// one there.
[[nodiscard]] std::vector<SitePair> pairs_of(const SiteGrid& a, const SiteGrid& b,
                                             const ComparisonOptions& options);

}  // namespace stormcellar::grid

// grid/judge/site_pairs.h -- cells of one site's grid, and the places where the faults of another
// site would show them.
//
// Only grid/judge/site_comparison.cpp uses this; its header says which cells are taken.
//
// Units     Columns of B's grid, meters up, degrees, seconds.
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/judge/site_comparison.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {

// A shift of a place in B's grid: columns, and meters up.
struct SiteShift {
    double x = 0;
    double y = 0;
    double up_m = 0;
};

// A cell of A, and how the faults of B move the place where B shows the same echo.
struct SitePair {
    double a_dbz = 0;
    ColumnPoint column;  // in B's grid, without any fault
    double height_m = 0;
    SiteShift by_azimuth, by_elevation, by_time;  // for a degree, a degree, a second
    double apart_s = 0;                           // how much later B looked
    std::uint32_t block = 0;
};

[[nodiscard]] inline ColumnPoint moved(ColumnPoint column, const SiteShift& shift, double times) {
    return {column.x + shift.x * times, column.y + shift.y * times};
}

// Returns cells of A that have a value, brick by brick, and each column from the bottom up. B need
// not have a value there.
[[nodiscard]] std::vector<SitePair> pairs_of(const SiteGrid& a, const SiteGrid& b,
                                             const ComparisonOptions& options);

}  // namespace stormcellar::grid

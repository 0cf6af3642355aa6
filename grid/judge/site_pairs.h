// grid/judge/site_pairs.h -- pairs cells of one site's grid with the places where another site
// shows the same echo. These places depend on the faults of that other site.
//
// Only grid/judge/site_comparison.cpp uses this; its header says which cells count.
//
// Units     Columns of B's grid, meters up, degrees, seconds.
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/judge/site_comparison.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {

// A shift of a place in B's grid.
struct SiteShift {
    double x = 0;
    double y = 0;
    double up_m = 0;
};

// A cell of A, and how B's faults move the place where B shows the same echo.
struct SitePair {
    double a_dbz = 0;
    ColumnPoint column;  // in B's grid, if B has no fault
    double height_m = 0;
    SiteShift by_azimuth, by_elevation, by_time;  // per degree, per degree and per second
    double apart_s = 0;                           // how much later B measured the echo than A
    std::uint32_t block = 0;
};

[[nodiscard]] inline ColumnPoint moved(ColumnPoint column, const SiteShift& shift, double times) {
    return {column.x + shift.x * times, column.y + shift.y * times};
}

// Returns cells of A that have a value, brick by brick, and each column from the bottom up. B may
// have no values there.
[[nodiscard]] std::vector<SitePair> pairs_of(const SiteGrid& a, const SiteGrid& b,
                                             const ComparisonOptions& options);

}  // namespace stormcellar::grid

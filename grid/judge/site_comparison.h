// grid/judge/site_comparison.h -- compares two sites over the same weather, and finds the faults
// that make them differ.
//
// Both grids hold the weather at one instant, each from its own site. Where both have echo, the
// four faults of B that make it differ from A are estimated together:
//   bias_db        B's values are higher than A's by this much.
//   azimuth_deg    B's echo is turned about B, clockwise: its azimuths are too large by this much.
//   elevation_deg  B's echo is raised, by range times this angle: its elevations are too large.
//   time_s         B's clock is late: it stamps what it sees too early by this much, so its echo is
//                  displaced along the motion. This needs a motion.
// Two sites cannot tell which of them is at fault. With three sites, the site that appears in both
// faulty pairs is at fault.
//
// Method    Least squares of A's cells minus B, where B is read at the places to which the faults
//           move the cells (trilinear), over the derivatives of the cells by each fault. Gauss and
//           Newton with B evaluated anew, Huber's weights, errors by the jackknife over blocks of
//           24 km (grid/judge/robust_fit.h). docs/geometry.md has the formulas.
// Cells     Every n-th column, at all levels, from `least_range_m` (clutter) to `greatest_range_m`
//           of both sites. A cell counts if A and the six neighbors of B have values. Their mean
//           must be at least `least_dbz`, so that no detection limit selects for one site.
// Untold    A fault that these cells do not determine is not guessed. This happens if there are too
//           few cells, if the sites hardly see the same (correlation), and if faults look alike
//           there. Without a motion it happens to the time, and also to azimuth and elevation if
//           the sites looked minutes apart.
// Grids     The grids may be windows of one domain or differ altogether, because places are
//           compared through the earth and columns through each grid's own projection. Reflectivity
//           only.
// Limits    Only faults that displace the echo by up to about 2 km are found.
// Accuracy  Enforced by tests/grid/site_comparison_test.cpp (synthetic weather seen by two sites
//           110 km apart, noise of 1 dB, storms at 25 m/s): 0.4 dB, 0.12 degrees of azimuth, 0.15
//           of elevation, 12 s.
// Threads   Pure functions, with the same bits every time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/cell_details.h"

namespace stormcellar::grid {

struct SiteGrid {
    BrickView view;
    SitePosition site;
    // Detail::age of the cells of the grid, in seconds after the instant; null if all cells are of
    // the instant. Ages count only if the motion is known.
    const CellDetails* details = nullptr;
};

// The motion of all the weather.
struct UniformMotion {
    double east_mps = 0;
    double north_mps = 0;
};

struct ComparisonOptions {
    std::optional<UniformMotion> motion;  // none: not known
    double least_dbz = 15;
    double least_range_m = 20e3;
    double greatest_range_m = 200e3;
    double least_correlation = 0.5;  // of A and B, after the faults were removed
    int most_columns = 6000;         // more columns are thinned
};

struct Estimate {
    double value = 0;
    double standard_error = 0;
    std::string untold;  // why there is no estimate; empty if there is one
};

struct SiteComparison {
    std::string a, b;  // ICAOs
    Estimate bias_db, azimuth_deg, elevation_deg, time_s;
    std::size_t cells = 0;    // cells compared in the last step
    std::size_t blocks = 0;   // blocks that hold them
    double deviation_db = 0;  // of A minus B, from its median, after the faults were removed
    double correlation = 0;   // of A and B, after the faults were removed
    double apart_s = 0;       // median time between the two looks at a cell
};

// Compares two sites. Too little echo is not an error; then the estimates are untold. Errors:
// bad_argument for options that are not finite and positive, or details of another size.
[[nodiscard]] Result<SiteComparison> compare_sites(const SiteGrid& a, const SiteGrid& b,
                                                   const ComparisonOptions& options = {});

// A fault is named if its estimate is larger than this limit and than this number of standard
// errors.
struct FaultLimits {
    double bias_db = 1;
    double azimuth_deg = 0.25;
    double elevation_deg = 0.25;
    double time_s = 15;
    double standard_errors = 3;
};

// Returns sentences such as "KB against KA: turned by 0.50 +- 0.03 degrees"; empty if there is no
// fault.
[[nodiscard]] std::vector<std::string> faults(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});
// Returns sentences such as "KB against KA: time not told: the motion is not known". They cover
// each fault that could not be determined, or whose error is so large that a fault of twice its
// limit would not be named.
[[nodiscard]] std::vector<std::string> untold(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});

}  // namespace stormcellar::grid

// grid/judge/site_comparison.h -- compares two sites over the same weather, and estimates the
// faults that make them differ.
//
// Both grids show the weather at one instant, each as its own site saw it. From the cells where
// both have echo, four faults of site B against site A are estimated together:
//   bias_db        B's values are higher than A's by this much.
//   azimuth_deg    B's echo is turned about B, clockwise: its azimuths are too large by this much.
//   elevation_deg  B's echo is raised, by range times this angle: its elevations are too large.
//   time_s         B's clock is late: B's time stamps are too early by this much, so B's echo is
//                  displaced along the motion. The estimate needs a motion.
// A comparison of two sites cannot tell which site is at fault. With three sites, the faulty site
// is in both pairs that differ.
//
// Method    Least squares of A's cells minus B. B is read (trilinear) at the places to which the
//           faults move the cells, and the derivatives are those of the cells with respect to each
//           fault. The fit uses steps of Gauss and Newton (B is read anew in each step), Huber's
//           weights, and the jackknife over blocks of 24 km (grid/judge/robust_fit.h).
//           docs/geometry.md has the formulas.
// Cells     Every n-th column, at all levels, at ranges from `least_range_m` (nearer cells have
//           clutter) to `greatest_range_m` from both sites. A cell counts if A has a value in the
//           cell and B has values in the cell and in its six neighbors. The mean of A and B must be
//           at least `least_dbz`, so that no site's detection limit decides which cells count.
// Unknown   A fault has no estimate if the cells do not determine it: there are too few cells, the
//           sites hardly see the same echo (correlation), or two faults have the same effect there.
//           Without a motion, the time has no estimate. If the sites also looked minutes apart,
//           azimuth and elevation have no estimate, either.
// Grids     Both grids may be windows of one domain, or they may differ altogether. Places are
//           compared through the earth, and columns through the projection of each grid.
//           Reflectivity only.
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
    // Detail::age of the cells, in seconds after the instant. Null if all cells are at the instant.
    // Ages are used only if the motion is known.
    const CellDetails* details = nullptr;
};

// The motion of all the weather.
struct UniformMotion {
    double east_mps = 0;
    double north_mps = 0;
};

struct ComparisonOptions {
    std::optional<UniformMotion> motion;  // none: the motion is unknown
    double least_dbz = 15;
    double least_range_m = 20e3;
    double greatest_range_m = 200e3;
    double least_correlation = 0.5;  // of A and B, after the removal of the faults
    int most_columns = 6000;         // if there are more, only every n-th is compared
};

struct Estimate {
    double value = 0;
    double standard_error = 0;
    std::string untold;  // the reason why there is no estimate; else empty
};

struct SiteComparison {
    std::string a, b;  // ICAOs
    Estimate bias_db, azimuth_deg, elevation_deg, time_s;
    std::size_t cells = 0;
    std::size_t blocks = 0;   // blocks that have cells
    double deviation_db = 0;  // of A minus B, after the removal of the faults (Fit::deviation)
    double correlation = 0;   // of A and B, after the removal of the faults
    double apart_s = 0;       // median time between the two measurements of a cell
};

// Compares two sites. Too little echo is no error: then no fault has an estimate, and `untold` says
// why. Errors: bad_argument for invalid options, such as NaN, or for details of another size.
[[nodiscard]] Result<SiteComparison> compare_sites(const SiteGrid& a, const SiteGrid& b,
                                                   const ComparisonOptions& options = {});

// The limits of the faults. A fault is named if its estimate exceeds its limit and also exceeds
// `standard_errors` times its standard error.
struct FaultLimits {
    double bias_db = 1;
    double azimuth_deg = 0.25;
    double elevation_deg = 0.25;
    double time_s = 15;
    double standard_errors = 3;
};

// Returns a sentence for each fault that is named, such as "KB against KA: turned by 0.50 +- 0.03
// degrees".
[[nodiscard]] std::vector<std::string> faults(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});
// Returns a sentence for each fault that has no estimate or an uncertain one, such as "KB against
// KA: time cannot be determined: the motion is not known". An estimate is uncertain if its standard
// error is so large that even a fault of twice the limit would not be named.
[[nodiscard]] std::vector<std::string> untold(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});

}  // namespace stormcellar::grid

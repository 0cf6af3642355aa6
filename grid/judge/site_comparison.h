// grid/judge/site_comparison.h -- compares two sites over the same weather, and estimates the
// faults that make them differ.
//
// Both grids show the weather at one instant, each from its own site. From the cells where both
// have echo, four faults of B against A are estimated together:
//   bias_db        B's values are higher than A's by this much.
//   azimuth_deg    B's echo is turned about B, clockwise: its azimuths are too large by this much.
//   elevation_deg  B's echo is raised, by range times this angle: its elevations are too large.
//   time_s         B's clock is late: B's time stamps are too early by this much, so B's echo is
//                  displaced along the motion. The estimate needs a motion.
// A comparison of two sites cannot tell which site is at fault. With three sites, the faulty site
// is in both pairs that differ.
//
// Method    Least squares of A's cells minus B, where B is read (trilinear) at the places to which
//           the faults move the cells, over the derivatives of the cells by each fault. The fit
//           uses Gauss and Newton with B evaluated anew in each step, Huber's weights, and the
//           jackknife over blocks of 24 km (grid/judge/robust_fit.h). docs/geometry.md has the
//           formulas.
// Cells     Every n-th column, at all levels, at ranges from `least_range_m` (nearer cells have
//           clutter) to `greatest_range_m` from both sites. A cell counts if A has a value there
//           and B has values in it and in its six neighbors. The mean of A and B must be at least
//           `least_dbz`, so that no site's detection limit decides which cells count.
// Untold    A fault that the cells do not determine has no estimate: if there are too few cells, if
//           the sites hardly see the same (correlation), or if faults have the same effect there.
//           Without a motion, the time has no estimate, and azimuth and elevation have none either
//           if the sites looked minutes apart.
// Grids     The grids may be windows of one domain or differ altogether, because places are
//           compared through the earth and columns through each grid's projection. Reflectivity
//           only.
// Limits    Finds only faults that displace the echo by up to about 2 km.
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
    // Detail::age of the grid's cells, in seconds after the instant; null if all cells are of the
    // instant. Ages count only if the motion is known.
    const CellDetails* details = nullptr;
};

// The motion of all the weather.
struct UniformMotion {
    double east_mps = 0;
    double north_mps = 0;
};

struct ComparisonOptions {
    std::optional<UniformMotion> motion;  // none: unknown
    double least_dbz = 15;
    double least_range_m = 20e3;
    double greatest_range_m = 200e3;
    double least_correlation = 0.5;  // of A and B, after removing the faults
    int most_columns = 6000;         // if there are more, every n-th is compared
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
    double deviation_db = 0;  // of A minus B, after removing the faults (Fit::deviation)
    double correlation = 0;   // of A and B, after removing the faults
    double apart_s = 0;       // median time between the two measurements of a cell
};

// Compares two sites. If there is too little echo, no fault has an estimate (`untold` says why);
// this is not an error. Errors: bad_argument for invalid options, such as NaN, or details of
// another size.
[[nodiscard]] Result<SiteComparison> compare_sites(const SiteGrid& a, const SiteGrid& b,
                                                   const ComparisonOptions& options = {});

// A fault is named if its estimate exceeds its limit and this number of standard errors.
struct FaultLimits {
    double bias_db = 1;
    double azimuth_deg = 0.25;
    double elevation_deg = 0.25;
    double time_s = 15;
    double standard_errors = 3;
};

// Returns sentences such as "KB against KA: turned by 0.50 +- 0.03 degrees", one for each fault.
[[nodiscard]] std::vector<std::string> faults(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});
// Returns sentences such as "KB against KA: time cannot be determined: the motion is not known",
// one for each fault that has no estimate or an uncertain one: with its standard error, even a
// fault of twice the limit would not be named.
[[nodiscard]] std::vector<std::string> untold(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});

}  // namespace stormcellar::grid

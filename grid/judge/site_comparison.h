// grid/judge/site_comparison.h -- two sites over the same weather: what one says otherwise than the
// other.
//
// Both grids hold the weather at one instant, each from its own site. Where both have echo the four
// faults of B that make it differ from A are estimated together:
//   bias_db        B's values are this much higher than A's
//   azimuth_deg    B's echo is turned about B, clockwise: its azimuths are this much too large
//   elevation_deg  B's echo is raised, by range times this angle: its elevations are too large
//   time_s         B's clock is late: it stamps what it sees this much too early, so that its echo
//                  is displaced along the motion. Needs a motion
// Which of the two is at fault two sites cannot tell; with three, the one in both faults.
// Method   least squares of A's cells minus B, taken where the faults have moved it (trilinear),
//          over the cells' derivatives by each fault; Gauss and Newton with B taken anew, Huber's
//          weights, errors by the jackknife over blocks of 24 km (grid/judge/robust_fit.h).
//          docs/geometry.md has the formulas.
// Cells    every so many columns; all levels; where both and B's six neighbours have values, whose
//          mean is at least `least_dbz` (so that no limit of detection chooses for one of them),
//          from `least_range_m` (clutter) to `greatest_range_m` of both.
// Untold   what these cells do not tell is not guessed: too few of them, sites that hardly see the
//          same (correlation), faults that look alike there; time without a motion; and without a
//          motion azimuth and elevation too where the sites looked minutes apart.
// Grids    may be windows of one domain or differ altogether: places are compared through the
//          earth, columns through each grid's own projection. Reflectivity alone.
// Found    faults up to the size of what gives them away: some 2 km of displacement.
// Accuracy enforced by tests/grid/site_comparison_test.cpp (synthetic weather seen by two sites 110
// km apart, noise
//          of 1 dB, storms at 25 m/s): 0.4 dB, 0.12 degrees of azimuth, 0.15 of elevation, 12 s.
// Threads  pure functions; the same bits every time.
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
    // Detail::age of the grid's cells, seconds after the instant; null: all are of the instant.
    // Counts where the motion is known.
    const CellDetails* details = nullptr;
};

// Of all the weather: where it goes.
struct UniformMotion {
    double east_mps = 0;
    double north_mps = 0;
};

struct ComparisonOptions {
    std::optional<UniformMotion> motion;  // none: not known
    double least_dbz = 15;
    double least_range_m = 20e3;
    double greatest_range_m = 200e3;
    double least_correlation = 0.5;  // of A and B, what was found taken out
    int most_columns = 6000;         // more are thinned
};

struct Estimate {
    double value = 0;
    double standard_error = 0;
    std::string untold;  // why there is none; empty: there is
};

struct SiteComparison {
    std::string a, b;  // ICAOs
    Estimate bias_db, azimuth_deg, elevation_deg, time_s;
    std::size_t cells = 0;    // compared at last
    std::size_t blocks = 0;   // that hold them
    double deviation_db = 0;  // of A minus B by its median, what was found taken out
    double correlation = 0;   // of A and B so
    double apart_s = 0;       // median time between the two looks at a cell
};

// Errors: bad_argument for options that are not finite and positive, or details of another size.
// Too little echo is none: the estimates then say so.
[[nodiscard]] Result<SiteComparison> compare_sites(const SiteGrid& a, const SiteGrid& b,
                                                   const ComparisonOptions& options = {});

// A fault is named where its estimate is larger than this, and than so many standard errors.
struct FaultLimits {
    double bias_db = 1;
    double azimuth_deg = 0.25;
    double elevation_deg = 0.25;
    double time_s = 15;
    double standard_errors = 3;
};

// "KB against KA: turned by 0.50 +- 0.03 degrees", and so on; empty: none.
[[nodiscard]] std::vector<std::string> faults(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});
// "KB against KA: time not told: the motion is not known": what could not be told, or so coarsely
// that a fault of twice its limit would not be named.
[[nodiscard]] std::vector<std::string> untold(const SiteComparison& comparison,
                                              const FaultLimits& limits = {});

}  // namespace stormcellar::grid

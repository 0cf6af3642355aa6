// retrieve/nowcast/nowcast.h -- moves the echo of the latest grid to a time within the next hour.
//
// Method    The motion of echo is estimated between each grid and the next
//           (grid/mosaic/motion.h). A nowcast takes, place by place, the median over the last four
//           pairs whose motion is known, and moves the latest grid along it
//           (grid/mosaic/extrapolation.h).
// Units     Reflectivity in dBZ, leads in minutes.
// Refused   A nowcast needs two grids or more of the same cells, at most 30 minutes apart, and a
//           motion that is known. Leads are at most 60 minutes, because storms change sooner than
//           they move away.
// Accuracy  On the five volumes of KBGM of 2005-08-22, the mean absolute error after 6, 13 and 18
//           minutes is 1.9, 2.3 and 2.6 dB, and the error of persistence is 2.7, 3.3 and 3.7 dB
//           (bench/compare_nowcast.py). There is no bound: retrieve/nowcast/hindcast.h measures the
//           error on the grids at hand, and pictures and files give the result.
// Not covered  Growth, decay and new storms; learned nowcasts.
// Source    Germann and Zawadzki (2002), Mon. Wea. Rev. 130, 2859.
// Threads   Pure functions. The results have the same bits for any number of threads.
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "grid/mosaic/motion.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::retrieve {

inline constexpr double longest_lead_minutes = 60;
inline constexpr double longest_gap_minutes = 30;

// A grid of reflectivity, and the middle time of its volume.
struct TimedGrid {
    grid::BrickView view;
    UtcTime time;
};

// The motion between each grid and the next; none where there is too little echo.
using PairMotions = std::vector<std::optional<grid::MotionField>>;

// Estimates the motions. Errors: bad_argument for less than two grids, grids of different cells,
// times that do not rise, and a gap of more than 30 minutes.
[[nodiscard]] Result<PairMotions> pair_motions(std::span<const TimedGrid> grids, int threads);

// Returns the motion by which a nowcast moves the last grid of the pairs, or none if no motion of
// the last four pairs is known.
[[nodiscard]] std::optional<grid::MotionField> latest_motion(
    std::span<const std::optional<grid::MotionField>> pairs, const grid::GridSpec& spec);

// Checks that a lead is above 0 and at most 60 minutes. Errors: bad_argument.
[[nodiscard]] Status check_lead(double minutes);

// Makes the nowcast of a lead from the latest grid. Errors: unmet if no motion is known; those of
// check_lead().
[[nodiscard]] Result<grid::BrickGrid> nowcast(
    const grid::BrickView& latest, std::span<const std::optional<grid::MotionField>> pairs,
    double minutes, int threads);

}  // namespace stormcellar::retrieve

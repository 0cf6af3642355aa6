// retrieve/nowcast/hindcast.h -- measures the error of nowcasts by lead time on the grids at hand.
//
// Method    Each grid but the first and the last is treated as the latest. From this grid and the
//           earlier grids, a nowcast is made for the time of each later grid within 60 minutes, and
//           compared with that later grid. Persistence, which is the unchanged grid, is compared in
//           the same way.
// Units     Maps of the maximum of each column, in dBZ. No echo, and anything below 0 dBZ, counts
//           as 0. Columns are compared that all three maps have seen. For the mean absolute error,
//           at least one of the three maps must have 5 dBZ or more.
// Score     CSI, the critical success index: columns with at least the threshold in both maps,
//           divided by columns with at least the threshold in one map or in both.
// Limits    The hindcasts of one sequence overlap, so they are not independent.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "retrieve/nowcast/nowcast.h"

namespace stormcellar::retrieve {

inline constexpr std::array<int, 2> csi_thresholds_dbz = {20, 35};

struct ForecastScore {
    double mean_absolute_db = 0;
    // For each threshold; none if no column of either map reaches it.
    std::array<std::optional<double>, csi_thresholds_dbz.size()> csi;
};

// The score of the hindcasts whose lead is nearest to `minutes`.
struct LeadScore {
    double minutes = 0;
    int hindcasts = 0;             // 0: there is nothing to measure, so the error is unknown
    double mean_lead_minutes = 0;  // of the hindcasts
    ForecastScore nowcast, persistence;
};

// Scores the leads, which must rise. A hindcast counts for the lead nearest to its own, if the two
// differ by at most 2.5 minutes. `pairs` are the pair_motions() of the grids. Errors: those of
// grid::extrapolate().
[[nodiscard]] Result<std::vector<LeadScore>> score_hindcasts(
    std::span<const TimedGrid> grids, std::span<const std::optional<grid::MotionField>> pairs,
    std::span<const double> leads_minutes, int threads);

// Returns the score in words for a picture, as in "measured on 3 hindcasts: CSI(35 dBZ) 0.62,
// persistence 0.48".
[[nodiscard]] std::string score_text(const LeadScore& score);

}  // namespace stormcellar::retrieve

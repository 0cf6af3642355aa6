#include "retrieve/nowcast/nowcast.h"

#include <algorithm>
#include <utility>

#include "grid/mosaic/extrapolation.h"

namespace stormcellar::retrieve {
namespace {

constexpr std::size_t most_pairs = 4;
constexpr double seconds_per_minute = 60;
// Blocks of this size tell storms from echo beside them that does not move, such as birds. With
// blocks of 64 km, the mean error of hindcasts of KBGM is 4 % larger (bench/compare_nowcast.py).
constexpr double block_m = 32'000, pixel_m = 1000;

Status check_sequence(std::span<const TimedGrid> grids) {
    if (grids.size() < 2) {
        return fail(ErrorCode::bad_argument,
                    "a nowcast needs the motion of echo, so it needs two volumes or more");
    }
    for (std::size_t i = 1; i < grids.size(); ++i) {
        const TimedGrid &before = grids[i - 1], &after = grids[i];
        if (*before.view.spec != *after.view.spec) {
            return fail(ErrorCode::bad_argument,
                        "a nowcast needs grids of the same area and cells; that of {} differs from "
                        "that of {}",
                        format_utc(after.time), format_utc(before.time));
        }
        const double minutes = seconds_between(before.time, after.time) / seconds_per_minute;
        if (minutes <= 0) {
            return fail(ErrorCode::bad_argument,
                        "a nowcast needs volumes of different times; two "
                        "are of {}",
                        format_utc(after.time));
        }
        if (minutes > longest_gap_minutes) {
            return fail(ErrorCode::bad_argument,
                        "the motion of echo is unknown over a gap of {:.0f} minutes, from {} to "
                        "{}; the longest is {:g}",
                        minutes, format_utc(before.time), format_utc(after.time),
                        longest_gap_minutes);
        }
    }
    return {};
}

}  // namespace

Result<PairMotions> pair_motions(std::span<const TimedGrid> grids, int threads) {
    if (Status fine = check_sequence(grids); !fine) return pass_on(fine);
    grid::MotionOptions options;
    options.block_m = block_m;
    options.pixel_m = pixel_m;
    options.threads = threads;
    PairMotions motions;
    for (std::size_t i = 1; i < grids.size(); ++i) {
        auto motion =
            grid::estimate_motion(grids[i - 1].view, grids[i].view,
                                  seconds_between(grids[i - 1].time, grids[i].time), options);
        if (!motion) return pass_on(motion);
        motions.push_back(std::move(*motion));
    }
    return motions;
}

std::optional<grid::MotionField> latest_motion(
    std::span<const std::optional<grid::MotionField>> pairs, const grid::GridSpec& spec) {
    std::vector<grid::MotionField> known;
    for (const auto& motion : pairs.last(std::min(pairs.size(), most_pairs))) {
        if (motion) known.push_back(*motion);
    }
    if (known.empty()) return std::nullopt;
    return grid::median_motion(known, spec);
}

Status check_lead(double minutes) {
    if (minutes > 0 && minutes <= longest_lead_minutes) return {};
    return fail(ErrorCode::bad_argument,
                "a nowcast by advection is for 1 to {:g} minutes, not {:g}; later, echo has grown "
                "or decayed too much",
                longest_lead_minutes, minutes);
}

Result<grid::BrickGrid> nowcast(const grid::BrickView& latest,
                                std::span<const std::optional<grid::MotionField>> pairs,
                                double minutes, int threads) {
    if (Status fine = check_lead(minutes); !fine) return pass_on(fine);
    const auto motion = latest_motion(pairs, *latest.spec);
    if (!motion) {
        return fail(ErrorCode::unmet,
                    "the motion is unknown, because there is too little echo; no nowcast is made");
    }
    return grid::extrapolate(latest, *motion, minutes * seconds_per_minute, threads);
}

}  // namespace stormcellar::retrieve

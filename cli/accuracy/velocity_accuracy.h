// cli/accuracy/velocity_accuracy.h -- `stormcellar accuracy --velocity`: measures for each rung of
// dealias() (each way to unfold velocities) its time, and how many fold numbers it gets wrong.
//
// The velocities are folded again at lower Nyquist velocities (retrieve/judge/refold.h), and each
// rung unfolds them. For a simulated scene, the true fold numbers are known exactly. For a file,
// the truth is the result of the rung `anchored` at the real Nyquist velocity, without its
// ambiguous gates. This favors `anchored`; bench/compare_dealiasing.py compares with other programs
// instead.
//
// Units     m/s; CPU seconds of one thread, the smallest of all rounds after the first.
// Threads   Runs on the calling thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "accuracy/plot.h"
#include "retrieve/judge/refold.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "synth/synth_scene.h"

namespace stormcellar::cli {

struct FoldRow {
    double nyquist_mps = 0;
    retrieve::Dealiasing rung = retrieve::Dealiasing::off;
    double time_s = 0;
    retrieve::FoldScore score;
    bool has_truth = false;             // false: the wrong gates of `score` are unknown
    std::optional<std::int64_t> jumps;  // jumps left in the result, at the real Nyquist velocity
    bool pareto = false;                // no other rung is as fast and as seldom wrong
};

struct FoldLadder {
    double real_nyquist_mps = 0;  // the highest of the volume
    bool is_truth_exact = false;
    std::vector<FoldRow> rows;  // by Nyquist velocity, from the real velocity down
};

// Measures each rung at the real Nyquist velocity, and at 20, 16, 12 and 8.5 m/s where these are
// lower. `scene` is the scene that the volume is from, or null. Errors: not_found if the volume has
// no velocities, no Nyquist velocity, or no gate whose true fold number is known.
[[nodiscard]] Result<FoldLadder> measure_dealiasing(
    const level2::Volume& volume, const synth::Scene* scene, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

// Return the results as text and as JSON. Both name the subject and the source of the truth.
[[nodiscard]] std::string format_fold_ladder(const std::string& subject, const FoldLadder& ladder,
                                             bool markdown);
[[nodiscard]] nlohmann::ordered_json fold_ladder_json(const std::string& subject,
                                                      const FoldLadder& ladder);
// Returns the plot of wrong gates against time. `below` is the line below its title.
[[nodiscard]] accuracy::Plot fold_plot(const FoldLadder& ladder, const std::string& below);

}  // namespace stormcellar::cli

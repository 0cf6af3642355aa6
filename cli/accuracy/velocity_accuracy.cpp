#include "cli/accuracy/velocity_accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy/timing.h"
#include "base/printable.h"
#include "stormcellar/accuracy/quantity.h"
#include "synth/velocity_truth.h"

namespace stormcellar::cli {
namespace {

using retrieve::Dealiased;
using retrieve::Dealiasing;
using retrieve::KnownVolume;

constexpr std::array lower_nyquists_mps = {20.0, 16.0, 12.0, 8.5};
constexpr std::array rungs = {Dealiasing::off, Dealiasing::profile, Dealiasing::region,
                              Dealiasing::anchored};
constexpr const char* no_figure = "-";

double highest_nyquist_mps(const level2::Volume& volume,
                           const std::vector<retrieve::SweepFolds>& folds) {
    float highest_mps = 0;
    for (const retrieve::SweepFolds& of : folds)
        for (const level2::Radial& radial : volume.sweeps[of.sweep].radials)
            highest_mps = std::max(highest_mps, radial.nyquist_mps);
    return highest_mps;
}

// Returns the scene's velocities as the truth. Speckle and noise show no wind, so their truth is
// unknown.
KnownVolume known_by_scene(const level2::Volume& volume, const synth::Scene& scene) {
    KnownVolume known{volume, retrieve::dealias(volume, Dealiasing::off).sweeps};
    for (retrieve::SweepFolds& folds : known.folds) {
        const synth::VelocityTruth truth =
            synth::velocity_truth(scene, volume.sweeps[folds.sweep], synth::VelocitySample::gate);
        if (truth.folds.size() != folds.folds.size()) {
            std::ranges::fill(folds.ambiguous, std::uint8_t{1});
            continue;
        }
        folds.folds = truth.folds;
        std::ranges::transform(truth.away_mps, folds.ambiguous.begin(), [](double away_mps) {
            return static_cast<std::uint8_t>(std::isnan(away_mps) ? 1 : 0);
        });
    }
    return known;
}

// Returns a row for each rung of dealias().
std::vector<FoldRow> measure_at(const KnownVolume& known, double nyquist_mps, int rounds) {
    std::array<Dealiased, rungs.size()> found;
    std::vector<std::function<void()>> works;
    for (std::size_t i = 0; i < rungs.size(); ++i)
        works.emplace_back([&, i] { found.at(i) = retrieve::dealias(known.volume, rungs.at(i)); });
    const auto timings = accuracy::time_in_rounds(works, rounds, accuracy::thread_s);
    std::vector<FoldRow> rows;
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        FoldRow& row = rows.emplace_back();
        row.nyquist_mps = nyquist_mps;
        row.rung = rungs.at(i);
        row.time_s = timings[i].least_s;
        row.score = retrieve::score_folds(known, found.at(i));
        row.jumps = retrieve::count_jumps(known.volume, found.at(i));
    }
    return rows;
}

void mark_front(std::vector<FoldRow>& rows) {
    const auto is_better = [](const FoldRow& a, const FoldRow& b) {
        const double wrong_a = a.score.wrong_share(), wrong_b = b.score.wrong_share();
        return a.time_s <= b.time_s && wrong_a <= wrong_b &&
               (a.time_s < b.time_s || wrong_a < wrong_b);
    };
    for (FoldRow& row : rows)
        row.pareto =
            std::ranges::none_of(rows, [&](const FoldRow& other) { return is_better(other, row); });
}

// Returns a text about the truth. `gap` is a blank or the end of a line.
std::string truth_of(const FoldLadder& ladder, std::string_view gap) {
    if (ladder.is_truth_exact) return fmt::format("that of the{}simulated scene", gap);
    return fmt::format(
        "the result of{}anchored at the real Nyquist velocity, without its ambiguous gates, which "
        "favors anchored",
        gap);
}

constexpr std::string_view words_of_rungs =
    "wrong: gates with a wrong fold number. ambiguous: gates that the rung marks as uncertain.\n"
    "wrong of rest: wrong gates among those not marked. jumps: pairs of adjacent gates that still\n"
    "differ by more than the Nyquist velocity. worth it: no other rung is as fast and as seldom\n"
    "wrong.\n";

struct FoldCells {
    std::string nyquist, rung, time, wrong, ambiguous, unmarked, jumps, pareto;
};

std::string percent(double share) {
    return fmt::format("{:.2f}", 100 * share);
}

FoldCells cells_of(const FoldRow& row, bool markdown) {
    const auto of_truth = [&](const std::string& text) { return row.has_truth ? text : no_figure; };
    return {fmt::format("{:g}", row.nyquist_mps),
            std::string(retrieve::dealiasing_name(row.rung)),
            markdown ? accuracy::format_number(row.time_s) : accuracy::format_seconds(row.time_s),
            of_truth(percent(row.score.wrong_share())),
            percent(row.score.ambiguous_share()),
            row.score.known_unmarked > 0 ? of_truth(percent(row.score.wrong_unmarked_share()))
                                         : no_figure,
            row.jumps ? std::to_string(*row.jumps) : no_figure,
            of_truth(row.pareto ? "yes" : "no")};
}

}  // namespace

Result<FoldLadder> measure_dealiasing(
    const level2::Volume& volume, const synth::Scene* scene, int rounds,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
    const KnownVolume known =
        scene != nullptr
            ? known_by_scene(volume, *scene)
            : KnownVolume{volume, retrieve::dealias(volume, Dealiasing::anchored).sweeps};
    if (known.folds.empty()) return fail(ErrorCode::not_found, "the volume has no velocities");
    FoldLadder ladder{highest_nyquist_mps(volume, known.folds), scene != nullptr, {}};
    if (!(ladder.real_nyquist_mps > 0)) {
        return fail(ErrorCode::not_found,
                    "the velocities have no Nyquist velocity, so they cannot be dealiased");
    }
    std::vector<double> lower_mps;
    std::ranges::copy_if(lower_nyquists_mps, std::back_inserter(lower_mps),
                         [&](double mps) { return mps < ladder.real_nyquist_mps; });
    ladder.rows = measure_at(known, ladder.real_nyquist_mps, rounds);
    if (ladder.rows.front().score.known == 0) {
        return fail(ErrorCode::not_found, "no gate has a velocity whose fold number is certain");
    }
    for (FoldRow& row : ladder.rows)
        row.has_truth = ladder.is_truth_exact;
    if (ladder.is_truth_exact) mark_front(ladder.rows);
    progress(1, lower_mps.size() + 1);
    for (std::size_t i = 0; i < lower_mps.size(); ++i) {
        const auto again = retrieve::refold(known, lower_mps[i]);
        if (!again) return pass_on(again);
        std::vector<FoldRow> rows = measure_at(*again, lower_mps[i], rounds);
        mark_front(rows);
        for (FoldRow& row : rows) {
            row.has_truth = row.score.known > 0;
            row.jumps.reset();
            ladder.rows.push_back(row);
        }
        progress(i + 2, lower_mps.size() + 1);
    }
    return ladder;
}

std::string format_fold_ladder(const std::string& subject, const FoldLadder& ladder,
                               bool markdown) {
    const std::string_view line = markdown ? "| {} | {} | {} | {} | {} | {} | {} | {} |\n"
                                           : "{:<8} {:<9} {:>9} {:>8} {:>10} {:>15} {:>8} {:>9}\n";
    const auto row_of = [&](const auto&... cells) {
        return fmt::format(fmt::runtime(line), cells...);
    };
    std::string text = fmt::format(
        "{}\n\nVelocities folded again at lower Nyquist velocities, and dealiased. The truth is "
        "{}.\n\n",
        printable(subject), truth_of(ladder, "\n"));
    if (markdown) {
        text += row_of("Nyquist (m/s)", "rung", "time_s", "wrong (%)", "ambiguous (%)",
                       "wrong of the rest (%)", "jumps", "Pareto");
        text += "|--:|---|--:|--:|--:|--:|--:|---|\n";
    } else {
        text += row_of("Nyquist", "rung", "time", "wrong", "ambiguous", "wrong of rest", "jumps",
                       "worth it");
        text += row_of("m/s", "", "", "%", "%", "%", "", "");
    }
    for (const FoldRow& row : ladder.rows) {
        const FoldCells cells = cells_of(row, markdown);
        text += row_of(cells.nyquist, cells.rung, cells.time, cells.wrong, cells.ambiguous,
                       cells.unmarked, cells.jumps, cells.pareto);
    }
    return markdown ? text : fmt::format("{}\n{}", text, words_of_rungs);
}

nlohmann::ordered_json fold_ladder_json(const std::string& subject, const FoldLadder& ladder) {
    nlohmann::ordered_json document{{"subject", subject},
                                    {"moment", level2::moment_name(level2::Moment::vel)},
                                    {"truth", truth_of(ladder, " ")}};
    auto& rows = document["rows"];
    rows = nlohmann::ordered_json::array();
    for (const FoldRow& row : ladder.rows) {
        nlohmann::ordered_json& item = rows.emplace_back();
        item["nyquist_mps"] = row.nyquist_mps;
        item["name"] = retrieve::dealiasing_name(row.rung);
        item["time_s"] = row.time_s;
        item["gates"] = row.score.gates;
        item["known_gates"] = row.has_truth ? row.score.known : 0;
        item["wrong"] = nullptr;
        item["ambiguous"] = row.score.ambiguous_share();
        item["wrong_unmarked"] = nullptr;
        item["jumps"] = nullptr;
        item["pareto"] = nullptr;
        if (row.jumps) item["jumps"] = *row.jumps;
        if (!row.has_truth) continue;
        item["wrong"] = row.score.wrong_share();
        if (row.score.known_unmarked > 0) item["wrong_unmarked"] = row.score.wrong_unmarked_share();
        item["pareto"] = row.pareto;
    }
    return document;
}

accuracy::Plot fold_plot(const FoldLadder& ladder, const std::string& below) {
    accuracy::Plot plot;
    plot.title = below;
    plot.error_label = "Gates with a wrong fold number (%)";
    plot.time_label = "Time of a volume";
    std::string wrong_by_region;
    for (const FoldRow& row : ladder.rows) {
        if (!row.has_truth) continue;
        constexpr double least_s = 1e-6;
        const std::string series = fmt::format("{:g} m/s", row.nyquist_mps);
        const std::string wrong = percent(row.score.wrong_share());
        plot.points.push_back({std::string(retrieve::dealiasing_name(row.rung)), series,
                               std::max(row.time_s, least_s), 100 * row.score.wrong_share(),
                               row.pareto});
        plot.main_series = series;
        if (row.rung == Dealiasing::region) wrong_by_region = wrong;
        if (row.rung == Dealiasing::anchored) {
            plot.title = fmt::format("Folded at {}, anchored gets {} % wrong, and region {} %",
                                     series, wrong, wrong_by_region);
            plot.below = {below};
        }
    }
    return plot;
}

}  // namespace stormcellar::cli

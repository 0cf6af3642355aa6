// teach_quality: scores the rules that tell weather from other echo
// (stormcellar/retrieve/quality.h) and prints new rules.
//
// usage: teach_quality [--data DIR] [--teach] [--json]
// The truth is the correlation coefficient: at least 0.95 is weather, less than 0.8 is other echo,
// and gates between count for neither. Two thirds of the dual-polarization volumes of the data
// directory teach, and the other third tests. Prints a row for each rule and test volume, and for
// each rule a row of all test volumes:
//   rule          dual or single
//   volume        its name, or all
//   other         gates with a correlation below 0.8
//   removed_pct   share of these with a probability below 0.5 (95 is asked for)
//   strong        gates of at least 20 dBZ and a correlation of at least 0.95
//   kept_pct      share of these with a probability of at least 0.5 (98 is asked for)
//   weak_pct      the same share of the weather below 20 dBZ
//   between_pct   the same share of gates with a correlation from 0.8 to 0.95
//   dense_pct     the same share of these gates with at least 35 dBZ, such as hail and melting snow
//   ms            CPU time of the rule for the volume
// and then, for ranges of the probability, the share of the gates (only other echo and weather)
// that are weather. With --teach, prints instead the text of retrieve/quality/taught_rules.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "bench/additive_fit.h"
#include "bench/request.h"
#include "bench/table.h"
#include "retrieve/quality/additive_rule.h"
#include "retrieve/quality/echo_features.h"
#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/retrieve/quality.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using level2::Moment;
using retrieve::Feature;
using retrieve::gate_field;
using retrieve::GateField;
using retrieve::QualityRule;

struct DataVolume {
    const char* path;
    bool teaches;
};
constexpr std::array<DataVolume, 13> dual_volumes = {{
    {"volumes/KATX20160427_095248_V06.gz", true},
    {"volumes/KCCX20130112_070503_V06.gz", true},
    {"volumes/KCRP20170826_044114.trimmed.ar2v", true},
    {"volumes/KDMX20250101_225441_V06", true},
    {"volumes/KLBB20160601_150025_V06", true},
    {"volumes/KLOT20220317_000842_V06", true},
    {"volumes/KTLX20140101_000624.trimmed.ar2v", true},
    {"chunks/KLOT_34", true},
    {"volumes/KDMX20220305_232324.trimmed.ar2v", false},
    {"volumes/KTLX20170101_030027_V06", false},
    {"volumes/Level2_KFTG_20150430_1419.ar2v", false},
    {"chunks/L2D_230", false},
    {"chunks/OPENRADAR_KLOT", false},
}};
constexpr std::array rules = {QualityRule::dual, QualityRule::single};

const char* name_of(QualityRule rule) {
    return rule == QualityRule::dual ? "dual" : "single";
}

// Calls `visit` with each reflectivity moment of a sweep with dual polarization, and the
// correlation at its gates.
template <class Visit>
void for_each_judged_sweep(const level2::Volume& volume, Visit visit) {
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        const level2::Sweep& sweep = volume.sweeps[s];
        const level2::SweepMoment* ref = sweep.find(Moment::ref);
        const level2::SweepMoment* rho = sweep.find(Moment::rho);
        if (ref == nullptr || rho == nullptr) continue;
        const GateField field = gate_field(sweep, *ref);
        const GateField correlation = gate_field(sweep, *rho);
        if (field.is_empty() || correlation.is_empty()) continue;
        std::vector<float> at_gates(field.codes.size(), std::numeric_limits<float>::quiet_NaN());
        for (std::size_t radial = 0; radial < field.radials; ++radial)
            for (std::size_t gate = 0; gate < field.gates; ++gate) {
                const std::int32_t there = correlation.gate_at(field.range_m(gate));
                if (there >= 0)
                    at_gates[radial * field.gates + gate] =
                        correlation.value(radial, static_cast<std::size_t>(there));
            }
        visit(s, field, at_gates);
    }
}

enum class Truth : std::uint8_t { none, other, between, dense, weak, strong };

Truth truth_of(float reflectivity, float correlation) {
    if (std::isnan(reflectivity) || std::isnan(correlation)) return Truth::none;
    if (correlation < 0.8F) return Truth::other;
    if (correlation < 0.95F) return reflectivity >= 35 ? Truth::dense : Truth::between;
    if (reflectivity >= 20) return Truth::strong;
    // Noise makes the correlation of weak echo wrong, and often larger than 1.
    return correlation <= 1 ? Truth::weak : Truth::none;
}

// Returns the weight of a lesson; 0 if it teaches nothing.
double weight_of(Truth truth) {
    switch (truth) {
        case Truth::other:
        case Truth::strong:
        case Truth::dense:
            return 1;
        case Truth::weak:
            return 0.5;
        case Truth::none:
        case Truth::between:
            break;
    }
    return 0;
}

// Gathers the lessons of a volume. Every volume weighs the same.
std::vector<Lesson> lessons_of(const level2::Volume& volume, QualityRule rule) {
    constexpr std::size_t most = 100'000;
    std::vector<Lesson> lessons;
    for_each_judged_sweep(volume, [&](std::size_t sweep, const GateField& field,
                                      const std::vector<float>& correlation) {
        const retrieve::EchoGates echo(field);
        GateField scratch;
        std::vector<Lesson> of_gates(echo.count());
        for (std::size_t radial = 0, i = 0; radial < field.radials; ++radial)
            for (const std::uint32_t gate : echo.of(radial)) {
                const Truth truth =
                    truth_of(field.value(radial, gate), correlation[radial * field.gates + gate]);
                Lesson& lesson = of_gates[i++];
                lesson.is_weather = truth != Truth::other;
                lesson.is_strong = truth == Truth::strong;
                lesson.weight = weight_of(truth);
            }
        retrieve::visit_features(
            volume, sweep, field, echo, rule, scratch,
            [&](Feature feature, std::size_t radial, std::span<const float> values) {
                for (std::size_t i = 0; i < values.size(); ++i)
                    of_gates[echo.begin(radial) + i].features[static_cast<std::size_t>(feature)] =
                        values[i];
            });
        std::ranges::copy_if(of_gates, std::back_inserter(lessons),
                             [](const Lesson& lesson) { return lesson.weight > 0; });
    });
    // Keep every n-th gate of a large volume.
    const std::size_t step = lessons.size() / most + 1;
    std::vector<Lesson> kept;
    for (std::size_t i = 0; i < lessons.size(); i += step)
        kept.push_back(lessons[i]);
    for (Lesson& lesson : kept)
        lesson.weight /= static_cast<double>(kept.size());
    return kept;
}

struct Score {
    std::array<std::int64_t, 6> gates{}, kept{};  // by Truth
    std::array<std::int64_t, 10> in_range{}, weather_in_range{};
    double ms = 0;

    void add(const Score& other) {
        for (std::size_t i = 0; i < gates.size(); ++i) {
            gates[i] += other.gates[i];
            kept[i] += other.kept[i];
        }
        for (std::size_t i = 0; i < in_range.size(); ++i) {
            in_range[i] += other.in_range[i];
            weather_in_range[i] += other.weather_in_range[i];
        }
        ms += other.ms;
    }
    [[nodiscard]] double kept_pct(Truth truth) const {
        const auto i = static_cast<std::size_t>(truth);
        return 100 * static_cast<double>(kept[i]) / static_cast<double>(gates[i]);
    }
    [[nodiscard]] int count(Truth truth) const {
        return static_cast<int>(gates[static_cast<std::size_t>(truth)]);
    }
};

Score score_of(const level2::Volume& volume, QualityRule rule) {
    Score score;
    const std::clock_t before = std::clock();
    const auto judged = retrieve::weather_probabilities(volume, rule == QualityRule::single);
    score.ms = 1000 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    for_each_judged_sweep(volume, [&](std::size_t sweep, const GateField& field,
                                      const std::vector<float>& correlation) {
        const auto quality = std::ranges::find(judged, sweep, &retrieve::SweepQuality::sweep);
        for (std::size_t at = 0; at < correlation.size(); ++at) {
            const Truth truth =
                truth_of(field.value(at / field.gates, at % field.gates), correlation[at]);
            if (truth == Truth::none) continue;
            const float probability = quality->probabilities[at];
            const auto i = static_cast<std::size_t>(truth);
            ++score.gates[i];
            score.kept[i] += probability >= 0.5F ? 1 : 0;
            if (truth == Truth::between || truth == Truth::dense) continue;
            const auto range = std::min<std::size_t>(9, static_cast<std::size_t>(probability * 10));
            ++score.in_range[range];
            score.weather_in_range[range] += truth != Truth::other ? 1 : 0;
        }
    });
    return score;
}

Row row_of(QualityRule rule, const std::string& volume, const Score& score) {
    return {{"rule", name_of(rule)},
            {"volume", volume},
            {"other", score.count(Truth::other)},
            {"removed_pct", Cell(100 - score.kept_pct(Truth::other), 2)},
            {"strong", score.count(Truth::strong)},
            {"kept_pct", Cell(score.kept_pct(Truth::strong), 2)},
            {"weak_pct", Cell(score.kept_pct(Truth::weak), 1)},
            {"between_pct", Cell(score.kept_pct(Truth::between), 1)},
            {"dense_pct", Cell(score.kept_pct(Truth::dense), 1)},
            {"ms", Cell(score.ms, 0)}};
}

Result<level2::Volume> volume_at(const Request& request, const DataVolume& from) {
    auto decoded = level2::decode_path(request.data_directory() / from.path);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

Status score_rules(const Request& request) {
    Table table(request.json);
    std::vector<Row> ranges;
    for (const QualityRule rule : rules) {
        Score all;
        for (const DataVolume& from : dual_volumes) {
            if (from.teaches) continue;
            const auto volume = volume_at(request, from);
            if (!volume) return pass_on(volume);
            const Score score = score_of(*volume, rule);
            all.add(score);
            table.add(row_of(rule, fs::path(from.path).filename(), score));
        }
        table.add(row_of(rule, "all", all));
        for (std::size_t i = 0; i < all.in_range.size(); ++i) {
            const double share = 100 * static_cast<double>(all.weather_in_range[i]) /
                                 static_cast<double>(all.in_range[i]);
            ranges.push_back({{"rule", name_of(rule)},
                              {"probability",
                               fmt::format("0.{} to {:.1f}", i, 0.1 * static_cast<double>(i + 1))},
                              {"gates", static_cast<int>(all.in_range[i])},
                              {"weather_pct", Cell(share, 1)}});
        }
    }
    for (Row& row : ranges)
        table.add(std::move(row));
    table.finish();
    return {};
}

Status teach_rules(const Request& request) {
    for (const QualityRule rule : rules) {
        std::vector<Lesson> lessons;
        for (const DataVolume& from : dual_volumes) {
            if (!from.teaches) continue;
            const auto volume = volume_at(request, from);
            if (!volume) return pass_on(volume);
            std::ranges::move(lessons_of(*volume, rule), std::back_inserter(lessons));
        }
        print_rule(name_of(rule), fit_rule(std::move(lessons), rule));
    }
    return {};
}

Status run(const Request& request) {
    return request.has("--teach") ? teach_rules(request) : score_rules(request);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argument_count, char** arguments) {
    using namespace stormcellar::bench;
    const std::span<char* const> all{arguments, static_cast<std::size_t>(argument_count)};
    const ReadRequest read = read_request(
        {"teach_quality", "", "Scores or teaches the rules for weather.", {"--teach"}}, all);
    if (!read.request) return read.status;
    return exit_status("teach_quality", run(*read.request));
}

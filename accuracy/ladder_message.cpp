#include "accuracy/ladder_message.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/printable.h"
#include "stormcellar/accuracy/quantity.h"

namespace stormcellar::accuracy {
namespace {

constexpr std::string_view default_mark = " (default)";
constexpr std::string_view whole_chains = "chain";
constexpr double least_gain = 0.9;

struct Rung {
    std::string name;
    double time_s = 0, error = 0;
    bool is_default = false, is_worth_it = false, is_color = false;
};

std::vector<Rung> rungs_of(std::span<const LadderRow> rows, std::string_view step) {
    std::vector<Rung> rungs;
    for (const LadderRow& row : rows) {
        const bool is_color = !row.value && row.image_p99_de;
        const double error = row.value ? row.value->p99 : row.image_p99_de.value_or(-1);
        const double time_s = row.kept_time_s.value_or(row.time_s);
        if (row.step != step || !(error >= 0) || !std::isfinite(error) || !(time_s > 0)) continue;
        Rung rung{printable(row.name), time_s, error, false, row.pareto, is_color};
        rung.is_default = rung.name.ends_with(default_mark);
        if (rung.is_default) rung.name.resize(rung.name.size() - default_mark.size());
        rungs.push_back(std::move(rung));
    }
    return rungs;
}

std::string two_digits(double ratio) {
    return ratio >= 10 ? fmt::format("{:.0f}", ratio) : fmt::format("{:.1f}", ratio);
}

std::string without_zero(std::string text) {
    if (text.ends_with(".0")) text.resize(text.size() - 2);
    return text;
}

// Returns a text such as "costs 6 times the time of linear".
std::string costs(const Rung& rung, const Rung& base) {
    const double ratio = rung.time_s / base.time_s;
    if (ratio >= 1.95)
        return fmt::format("costs {} times the time of {}", without_zero(two_digits(ratio)),
                           base.name);
    if (ratio >= 1.05)
        return fmt::format("costs {:.0f} % more time than {}", 100 * (ratio - 1), base.name);
    return fmt::format("costs no more time than {}", base.name);
}

std::string error_in_words(const Rung& rung, ValueUnit unit) {
    if (rung.is_color) return fmt::format("dE {}", format_number(rung.error));
    return fmt::format("{} {}", format_number(rung.error), name_of(unit));
}

// Returns a text such as "halves the error".
std::string gains(const Rung& rung, const Rung& base, ValueUnit unit) {
    if (rung.error <= 0) return "leaves no error";
    const double ratio = base.error / rung.error;
    if (ratio >= 1.8 && ratio <= 2.2) return "halves the error";
    if (ratio > 2.2) {
        return fmt::format("divides the error by {} (to {})", without_zero(two_digits(ratio)),
                           error_in_words(rung, unit));
    }
    return fmt::format("lowers the error by {:.0f} % (to {})", 100 * (1 - 1 / ratio),
                       error_in_words(rung, unit));
}

// Returns log(fall of the error) / log(rise of the time) from `base` to `rung`. Returns 0 for a
// rung without error, so that this rung is chosen only if no other rung can be chosen.
double bargain(const Rung& rung, const Rung& base) {
    if (rung.error <= 0) return 0;
    return std::log(base.error / rung.error) / std::log(std::max(1.01, rung.time_s / base.time_s));
}

}  // namespace

std::string LadderMessage::sentence() const {
    if (buy.empty()) return "";
    return beyond.empty() ? buy : buy + "; " + beyond;
}

LadderMessage message_of(std::span<const LadderRow> rows, std::string_view step, ValueUnit unit) {
    std::vector<Rung> rungs = rungs_of(rows, step);
    if (rungs.size() < 2) return {};
    std::ranges::stable_sort(rungs, {}, &Rung::time_s);
    const auto marked = std::ranges::find(rungs, true, &Rung::is_default);
    const Rung base = marked == rungs.end() ? rungs.front() : *marked;
    // The rungs that are slower and more accurate than the base, in order of time. Each is more
    // accurate than the rung before it.
    std::vector<Rung> better;
    for (const Rung& rung : rungs) {
        const double last = better.empty() ? base.error : better.back().error;
        const bool is_better = rung.time_s > base.time_s && rung.error < last;
        if (is_better && rung.is_worth_it) better.push_back(rung);
    }
    if (better.empty())
        return {std::string(step),
                fmt::format("no slower rung has a smaller error than {}", base.name), ""};
    // A gain of less than a tenth is too small to mention.
    const auto step_up = std::ranges::find_if(
        better, [&](const Rung& rung) { return rung.error <= least_gain * base.error; });
    const auto best = step_up == better.end() ? better.begin() : step_up;
    LadderMessage message{
        std::string(step),
        fmt::format("{} {} and {}", best->name, costs(*best, base), gains(*best, base, unit)), ""};
    const auto next = std::max_element(best + 1, better.end(), [&](const Rung& a, const Rung& b) {
        return bargain(a, *best) < bargain(b, *best);
    });
    if (next == better.end()) return message;
    Rung it = *best;
    it.name = "that";
    message.beyond = fmt::format("beyond it, {} {} and {}", next->name, costs(*next, it),
                                 gains(*next, it, unit));
    return message;
}

LadderMessage message_of(std::span<const LadderRow> rows, ValueUnit unit) {
    std::map<std::string, std::size_t> sizes;
    for (const LadderRow& row : rows)
        ++sizes[row.step];
    if (sizes.contains(std::string(whole_chains))) return message_of(rows, whole_chains, unit);
    std::string step;
    for (const LadderRow& row : rows) {
        if (step.empty() || sizes[row.step] > sizes[step]) step = row.step;
    }
    return message_of(rows, step, unit);
}

}  // namespace stormcellar::accuracy

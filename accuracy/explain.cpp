#include "accuracy/explain.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar::accuracy {
namespace {

constexpr std::size_t line_length = 80;
constexpr std::size_t indent = 5;

// Breaks a text into as many indented lines as it needs.
std::string wrapped(std::string_view words) {
    std::string text;
    std::string line;
    while (!words.empty()) {
        const std::size_t space = words.find(' ');
        const std::string_view word = words.substr(0, space);
        words.remove_prefix(space == std::string_view::npos ? words.size() : space + 1);
        if (word.empty()) continue;
        if (!line.empty() && indent + line.size() + 1 + word.size() > line_length) {
            text += std::string(indent, ' ') + line + "\n";
            line.clear();
        }
        if (!line.empty()) line += ' ';
        line += word;
    }
    if (!line.empty()) text += std::string(indent, ' ') + line + "\n";
    return text;
}

// Returns a share of the budget as text, or "-" if the budget bounds only the time and so has no
// shares.
std::string percent(const Plan& plan, double share) {
    if (!plan.budget.bounds_errors()) return "-";
    if (std::isinf(share)) return "over";
    return format_number(share * 100) + " %";
}

struct Line {
    std::string state;
    std::string name;
    std::string predicted;
    std::string share;
    std::string evidence;
    std::string below;  // an indented explanation, printed below this line
};

std::vector<Line> lines_of(const Plan& plan) {
    std::vector<Line> lines{{"", "effect", "predicted", "of budget", "by", ""}};
    std::size_t off = 0;
    for (const Decision& decision : plan.decisions) {
        if (!decision.on && decision.is_asked) ++off;
        lines.push_back(
            {decision.on ? "on" : "off", decision.effect,
             format_size(decision.predicted, plan.value_unit), percent(plan, decision.share),
             std::string(name_of(decision.evidence)),
             wrapped(printable(decision.what)) + wrapped("Why: " + decision.reason + ".")});
    }
    lines.push_back({"sum", fmt::format("of {} left off", off),
                     format_size(plan.left_off, plan.value_unit),
                     percent(plan, worst_share(plan.left_off, plan.budget)), "", ""});
    return lines;
}

std::string measured_text(const Plan& plan) {
    if (plan.measured_choices == 0) return "Measured: nothing, the plan rests on predictions.\n";
    std::string text = fmt::format("Measured: {} {} in {}", plan.measured_choices,
                                   plan.measured_choices == 1 ? "choice" : "choices",
                                   format_seconds(plan.measuring_s));
    if (!plan.measured) return text + "; this one rests on proven bounds.\n";
    text += "; this one errs by at most";
    std::string_view separator = " ";
    for (const Quantity quantity : all_quantities) {
        const auto bound = plan.measured->of(quantity);
        const bool budgeted = plan.budget.limit(quantity).has_value();
        if (!budgeted && (!bound || *bound == 0)) continue;
        text += separator;
        text += bound ? format_quantity(quantity, *bound, plan.value_unit) : "(too few samples)";
        separator = ", ";
    }
    if (plan.measured->status.compared > 0) {
        text += fmt::format("; the status differs in {} % of the cells compared",
                            format_number(plan.measured->status.share() * 100));
    }
    return text + ".\n";
}

}  // namespace

std::string explain(const Plan& plan) {
    std::string text;
    const bool none = !plan.budget.bounds_errors() && !plan.budget.time_s;
    text += fmt::format("Budget: {}\n", none ? "none" : format_budget(plan.budget));
    text += fmt::format("Chosen: {}\n", plan.description);
    text += fmt::format("Time:   {} predicted\n\n", format_seconds(plan.cost_s));
    const std::vector<Line> lines = lines_of(plan);
    std::size_t name = 0;
    std::size_t predicted = 0;
    std::size_t share = 0;
    for (const Line& line : lines) {
        name = std::max(name, line.name.size());
        predicted = std::max(predicted, line.predicted.size());
        share = std::max(share, line.share.size());
    }
    for (const Line& line : lines) {
        std::string row =
            fmt::format("{:<4} {:<{}}  {:<{}}  {:>{}}  {}", line.state, line.name, name,
                        line.predicted, predicted, line.share, share, line.evidence);
        row.erase(row.find_last_not_of(' ') + 1);
        text += row + "\n" + line.below;
    }
    text += "\n" + measured_text(plan);
    if (!plan.meets_budget) text += fmt::format("NOT MET: {}.\n", plan.shortfall);
    return text;
}

}  // namespace stormcellar::accuracy

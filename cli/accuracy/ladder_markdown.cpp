#include "cli/accuracy/ladder_markdown.h"

#include <algorithm>

#include <fmt/format.h>

#include "stormcellar/accuracy/quantity.h"

namespace stormcellar::cli {
namespace {

using accuracy::format_number;

constexpr const char* none = "-";

std::string position_of(const accuracy::LadderRow& row) {
    if (!row.position_max_m) return none;
    return fmt::format("{} / {}", format_number(*row.position_max_m),
                       row.position_rms_m ? format_number(*row.position_rms_m) : none);
}

std::string value_of(const accuracy::LadderRow& row) {
    if (!row.value) return none;
    return fmt::format("{} / {} / {} / {}", format_number(row.value->rms),
                       format_number(row.value->p95), format_number(row.value->p99),
                       format_number(row.value->max));
}

bool is_of_pictures(std::span<const accuracy::LadderRow> rows) {
    return std::any_of(rows.begin(), rows.end(),
                       [](const auto& row) { return row.image_p99_de && !row.value; });
}

std::string picture_markdown(std::span<const accuracy::LadderRow> rows) {
    std::string text =
        "| step | rung | time_s | color p99 (dE) | Pareto |\n|---|---|--:|--:|---|\n";
    for (const accuracy::LadderRow& row : rows) {
        text += fmt::format(
            "| {} | {} | {} | {} | {} |\n", row.step, row.name, format_number(row.time_s),
            row.image_p99_de ? format_number(*row.image_p99_de) : none, row.pareto ? "yes" : "no");
    }
    return text;
}

}  // namespace

std::string ladder_markdown(std::span<const accuracy::LadderRow> rows, accuracy::ValueUnit unit) {
    if (is_of_pictures(rows)) return picture_markdown(rows);
    std::string text = fmt::format(
        "| step | rung | time_s | position max / rms (m) | value rms / p95 / p99 / max ({}) | "
        "status differs (%) | Pareto |\n|---|---|--:|--:|--:|--:|---|\n",
        accuracy::name_of(unit));
    for (const accuracy::LadderRow& row : rows) {
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", row.step, row.name,
                            format_number(row.kept_time_s.value_or(row.time_s)), position_of(row),
                            value_of(row),
                            row.status ? fmt::format("{:.2f}", 100 * row.status->share()) : none,
                            row.pareto ? "yes" : "no");
    }
    return text;
}

}  // namespace stormcellar::cli

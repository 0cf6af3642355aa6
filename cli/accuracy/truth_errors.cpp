#include "cli/accuracy/truth_errors.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace stormcellar::cli {

std::string format_truth(const std::vector<synth::TruthRow>& rows, accuracy::ValueUnit unit,
                         bool markdown) {
    const std::string_view name = accuracy::name_of(unit);
    const std::string_view line = markdown ? "| {} | {} | {} | {} | {} | {} | {} |\n"
                                           : "{:<18} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n";
    const auto row_of = [&](const auto&... cells) {
        return fmt::format(fmt::runtime(line), cells...);
    };
    std::string text =
        row_of("chain", fmt::format("rms {}", name), fmt::format("p95 {}", name),
               fmt::format("p99 {}", name), fmt::format("mean {}", name), "missed %", "invented %");
    if (markdown) text += "|---|---|---|---|---|---|---|\n";
    for (const synth::TruthRow& row : rows) {
        const auto two = [](double number) { return fmt::format("{:.2f}", number); };
        text += row_of(row.chain, two(row.error.rms), two(row.error.p95), two(row.error.p99),
                       two(row.mean), two(100 * row.echo_missed), two(100 * row.echo_invented));
    }
    return text;
}

void add_errors(const accuracy::ErrorSummary& errors, nlohmann::ordered_json& row) {
    row["count"] = errors.count;
    row["rms"] = errors.rms;
    row["p95"] = errors.p95;
    row["p99"] = errors.p99;
    row["max"] = errors.max;
}

nlohmann::ordered_json truth_json(const std::vector<synth::TruthRow>& rows) {
    auto list = nlohmann::ordered_json::array();
    for (const synth::TruthRow& row : rows) {
        nlohmann::ordered_json& item = list.emplace_back();
        item["chain"] = row.chain;
        add_errors(row.error, item);
        item["mean"] = row.mean;
        item["echo_missed"] = row.echo_missed;
        item["echo_invented"] = row.echo_invented;
    }
    return list;
}

}  // namespace stormcellar::cli

#include "service/metrics_writer.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar {
namespace {

// The words, in the order of MetricsWriter::Type.
constexpr std::array<std::string_view, 4> words = {"counter", "gauge", "summary", "histogram"};

// Escapes a label value. printable() has replaced line ends and invalid UTF-8. The backslashes that
// printable() wrote are escaped like other backslashes.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char letter : printable(text)) {
        if (letter == '\\' || letter == '"') result += '\\';
        result += letter;
    }
    return result;
}

std::string number(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
    return fmt::format("{}", value);
}

}  // namespace

void MetricsWriter::family(std::string_view name, Type type, std::string_view help) {
    name_ = name;
    text_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name,
                         words.at(static_cast<std::size_t>(type)));
}

void MetricsWriter::line(std::string_view suffix, std::span<const Label> labels, const Label& extra,
                         std::string_view value) {
    text_ += name_;
    text_ += suffix;
    std::string inside;
    const auto add = [&](const Label& label) {
        inside += fmt::format("{}{}=\"{}\"", inside.empty() ? "" : ",", label.first,
                              escaped(label.second));
    };
    for (const Label& label : labels)
        add(label);
    if (!extra.first.empty()) add(extra);
    if (!inside.empty()) text_ += fmt::format("{{{}}}", inside);
    text_ += fmt::format(" {}\n", value);
}

void MetricsWriter::sample(double value, Labels labels) {
    line("", labels, {}, number(value));
}

void MetricsWriter::sample(double value, std::span<const Label> labels) {
    line("", labels, {}, number(value));
}

void MetricsWriter::sample(std::uint64_t value, Labels labels) {
    line("", labels, {}, fmt::format("{}", value));
}

void MetricsWriter::sample(const Timings& timings, Labels labels) {
    const LatencySummary summary = timings.summary();
    if (summary.count > 0) {
        line("", labels, {"quantile", "0.5"}, number(summary.median));
        line("", labels, {"quantile", "0.95"}, number(summary.p95));
        line("", labels, {"quantile", "1"}, number(summary.max));
    }
    line("_sum", labels, {}, number(timings.sum_s()));
    line("_count", labels, {}, fmt::format("{}", timings.count()));
}

void MetricsWriter::sample(std::span<const double> bounds, std::span<const std::uint64_t> counts,
                           double sum, const Label& label) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        count += counts[i];
        const std::string bound = i < bounds.size() ? number(bounds[i]) : "+Inf";
        line("_bucket", {&label, 1}, {"le", bound}, fmt::format("{}", count));
    }
    line("_sum", {&label, 1}, {}, number(sum));
    line("_count", {&label, 1}, {}, fmt::format("{}", count));
}

}  // namespace stormcellar

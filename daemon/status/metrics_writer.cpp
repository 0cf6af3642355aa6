#include "daemon/status/metrics_writer.h"

#include <cmath>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar::daemon {
namespace {

std::string_view word_of(MetricsWriter::Type type) {
    switch (type) {
        case MetricsWriter::Type::counter:
            return "counter";
        case MetricsWriter::Type::gauge:
            return "gauge";
        case MetricsWriter::Type::summary:
            return "summary";
    }
    return "untyped";
}

// printable() leaves neither line ends nor broken UTF-8; a backslash that it wrote is an ordinary
// one here.
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
    text_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, word_of(type));
}

void MetricsWriter::line(std::string_view suffix, Labels labels, std::string_view quantile,
                         std::string_view value) {
    text_ += name_;
    text_ += suffix;
    std::string inside;
    for (const auto& [label, text] : labels)
        inside += fmt::format("{}{}=\"{}\"", inside.empty() ? "" : ",", label, escaped(text));
    if (!quantile.empty())
        inside += fmt::format("{}quantile=\"{}\"", inside.empty() ? "" : ",", quantile);
    if (!inside.empty()) text_ += fmt::format("{{{}}}", inside);
    text_ += fmt::format(" {}\n", value);
}

void MetricsWriter::sample(double value, Labels labels) {
    line("", labels, "", number(value));
}

void MetricsWriter::sample(std::uint64_t value, Labels labels) {
    line("", labels, "", fmt::format("{}", value));
}

void MetricsWriter::sample(const Timings& timings, Labels labels) {
    const LatencySummary summary = timings.summary();
    if (summary.count > 0) {
        line("", labels, "0.5", number(summary.median));
        line("", labels, "0.95", number(summary.p95));
        line("", labels, "1", number(summary.max));
    }
    line("_sum", labels, "", number(timings.sum_s()));
    line("_count", labels, "", fmt::format("{}", timings.count()));
}

}  // namespace stormcellar::daemon

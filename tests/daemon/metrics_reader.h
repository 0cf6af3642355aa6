// tests/daemon/metrics_reader.h -- a strict reader of Prometheus' text format 0.0.4.
//
// Throws std::runtime_error with the line for whatever the format does not allow, and for what our
// own text shall not hold: a family without HELP or TYPE, one that appears twice, a series twice.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace stormcellar::daemon {

struct MetricFamily {
    std::string type, help;
    // By the whole of what stands before the value, labels sorted: NAME{a="x",b="y"}.
    std::map<std::string, double> samples;
};

[[nodiscard]] std::map<std::string, MetricFamily> read_metrics(const std::string& text);

}  // namespace stormcellar::daemon

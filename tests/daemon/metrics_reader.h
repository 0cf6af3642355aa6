// tests/daemon/metrics_reader.h -- a strict reader of Prometheus' text format 0.0.4.
//
// It throws std::runtime_error with the line for everything that the format forbids, and for what
// our own text must not contain: a family without HELP or TYPE, a family twice, a series twice.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace stormcellar::daemon {

struct MetricFamily {
    std::string type, help;
    // By the name with its sorted labels: NAME{a="x",b="y"}.
    std::map<std::string, double> samples;
};

[[nodiscard]] std::map<std::string, MetricFamily> read_metrics(const std::string& text);

}  // namespace stormcellar::daemon

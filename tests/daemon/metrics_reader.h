// tests/daemon/metrics_reader.h -- a strict reader of Prometheus' text format 0.0.4.
//
// The reader throws std::runtime_error, with the line, for everything that the format forbids. Our
// text must also have HELP and TYPE for each family, and each family and series only once;
// otherwise the reader throws, too.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace stormcellar::daemon {

struct MetricFamily {
    std::string type, help;
    // The key is the name with its sorted labels: NAME{a="x",b="y"}.
    std::map<std::string, double> samples;
};

[[nodiscard]] std::map<std::string, MetricFamily> read_metrics(const std::string& text);

}  // namespace stormcellar::daemon

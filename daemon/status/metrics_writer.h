// daemon/status/metrics_writer.h -- the text format in which Prometheus reads metrics, version
// 0.0.4.
//
// One family after the other: "# HELP", "# TYPE", then its samples, one line each:
//   name{label="value",...} 12.5
// Label values are escaped (\\ \" \n); bytes that are not UTF-8 become \xNN, as elsewhere. A number
// is written so that reading it gives the same double; NaN, +Inf and -Inf have these names. Source:
// prometheus.io, "Exposition formats". tests/daemon/metrics_reader.h reads the format strictly.
// Thread contract: one thread.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/status/timings.h"

namespace stormcellar::daemon {

inline constexpr std::string_view metrics_content_type = "text/plain; version=0.0.4; charset=utf-8";

class MetricsWriter {
  public:
    using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

    enum class Type { counter, gauge, summary };
    // Begins a family. A name is used once, and its samples follow before the next family begins.
    void family(std::string_view name, Type type, std::string_view help);
    void sample(double value, Labels labels = {});
    void sample(std::uint64_t value, Labels labels = {});
    // For the family of a summary: the median, 95th percentile and maximum (quantiles 0.5, 0.95 and
    // 1) of the last values, if there are any; the sum and count of all values since the start.
    void sample(const Timings& timings, Labels labels = {});

    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    void line(std::string_view suffix, Labels labels, std::string_view quantile,
              std::string_view value);

    std::string name_;
    std::string text_;
};

}  // namespace stormcellar::daemon

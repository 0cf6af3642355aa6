// service/metrics_writer.h -- writes metrics in the text format of Prometheus, version 0.0.4.
//
// Each family has the lines "# HELP" and "# TYPE", and then a line for each sample:
//   name{label="value",...} 12.5
// Label values are escaped (\\ \" \n), and bytes that are not UTF-8 become \xNN. Finite numbers
// have enough digits to read the same double back; other numbers are NaN, +Inf or -Inf.
//
// Threads   One thread at a time.
// Source    prometheus.io, "Exposition formats". tests/daemon/metrics_reader.h checks it strictly.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "service/timings.h"

namespace stormcellar {

inline constexpr std::string_view metrics_content_type = "text/plain; version=0.0.4; charset=utf-8";

class MetricsWriter {
  public:
    using Label = std::pair<std::string_view, std::string_view>;
    using Labels = std::initializer_list<Label>;

    enum class Type { counter, gauge, summary, histogram };
    // Begins a family. Use each name once, and write all samples of a family before the next
    // family.
    void family(std::string_view name, Type type, std::string_view help);
    void sample(double value, Labels labels = {});
    void sample(double value, std::span<const Label> labels);
    void sample(std::uint64_t value, Labels labels = {});
    // Writes a sample of a summary. If there are last values, the sample has their median, 95th
    // percentile and maximum (quantiles 0.5, 0.95 and 1). The sample also has the sum and the count
    // of all values.
    void sample(const Timings& timings, Labels labels = {});
    // Writes a sample of a histogram with one label. Each element of `counts` is the number of
    // values between a bound and the bound before it; the last element is the number of values
    // above all bounds. `sum` is the sum of all values.
    void sample(std::span<const double> bounds, std::span<const std::uint64_t> counts, double sum,
                const Label& label);

    // Each of these functions writes a family of one sample without labels.
    void gauge(std::string_view name, std::string_view help, double value) {
        family(name, Type::gauge, help);
        sample(value);
    }
    void gauge(std::string_view name, std::string_view help, std::uint64_t value) {
        family(name, Type::gauge, help);
        sample(value);
    }
    void counter(std::string_view name, std::string_view help, std::uint64_t value) {
        family(name, Type::counter, help);
        sample(value);
    }
    void summary(std::string_view name, std::string_view help, const Timings& timings) {
        family(name, Type::summary, help);
        sample(timings);
    }

    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    // `extra` is a further label. It is left out if its name is empty.
    void line(std::string_view suffix, std::span<const Label> labels, const Label& extra,
              std::string_view value);

    std::string name_;
    std::string text_;
};

}  // namespace stormcellar

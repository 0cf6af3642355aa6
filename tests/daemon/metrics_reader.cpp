#include "tests/daemon/metrics_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace stormcellar::daemon {
namespace {

[[noreturn]] void refuse(const std::string& line, const char* why) {
    throw std::runtime_error(std::string{why} + ": " + line);
}

double number(const std::string& text, const std::string& line) {
    if (text == "NaN") return std::numeric_limits<double>::quiet_NaN();
    if (text == "+Inf") return std::numeric_limits<double>::infinity();
    if (text == "-Inf") return -std::numeric_limits<double>::infinity();
    static const std::regex shape(R"(-?[0-9]+(\.[0-9]+)?(e[+-]?[0-9]+)?)");
    if (!std::regex_match(text, shape)) refuse(line, "no number");
    return std::stod(text);
}

// Returns the labels between { and }, sorted. Checks escapes and keeps them.
std::string sorted_labels(const std::string& inside, const std::string& line) {
    static const std::regex one(R"re(([a-zA-Z_][a-zA-Z0-9_]*)="((?:[^"\\\n]|\\["\\n])*)")re");
    std::vector<std::string> labels;
    auto at = inside.cbegin();
    while (at != inside.cend()) {
        std::smatch found;
        if (!std::regex_search(at, inside.cend(), found, one,
                               std::regex_constants::match_continuous)) {
            refuse(line, "no label");
        }
        labels.push_back(found[0]);
        at = found[0].second;
        if (at != inside.cend() && *at++ != ',') refuse(line, "no comma");
    }
    std::sort(labels.begin(), labels.end());
    std::string text;
    for (const std::string& label : labels)
        text += (text.empty() ? "" : ",") + label;
    return text;
}

class Reader {
  public:
    void take(const std::string& line) {
        static const std::regex comment(R"(# (HELP|TYPE) ([a-zA-Z_:][a-zA-Z0-9_:]*) (.+))");
        static const std::regex sample(
            R"re(([a-zA-Z_:][a-zA-Z0-9_:]*)(?:\{((?:[^"]|"(?:[^"\\]|\\.)*")*)\})? ([^ ]+))re");
        std::smatch found;
        if (std::regex_match(line, found, comment)) {
            found[1] == "HELP" ? begin(found[2], found[3], line) : type(found[2], found[3], line);
        } else if (std::regex_match(line, found, sample)) {
            add(found[1], found[2], found[3], line);
        } else {
            refuse(line, "no line of the format");
        }
    }
    std::map<std::string, MetricFamily> families;

  private:
    void begin(const std::string& name, const std::string& help, const std::string& line) {
        if (!families.emplace(name, MetricFamily{"", help, {}}).second)
            refuse(line, "a family twice");
        current_ = name;
    }
    void type(const std::string& name, const std::string& word, const std::string& line) {
        MetricFamily& family = families[current_];
        if (name != current_ || !family.type.empty()) refuse(line, "a type out of place");
        if (word != "counter" && word != "gauge" && word != "summary" && word != "histogram")
            refuse(line, "no type");
        if ((word == "counter") != name.ends_with("_total"))
            refuse(line, "counters, and they alone, end with _total");
        family.type = word;
    }
    void add(const std::string& name, const std::string& inside, const std::string& value,
             const std::string& line) {
        MetricFamily& family = families[current_];
        if (family.type.empty()) refuse(line, "a sample without a type");
        const bool is_summary = family.type == "summary", is_histogram = family.type == "histogram";
        const bool is_part = name == current_ + "_sum" || name == current_ + "_count";
        const bool is_bucket = is_histogram && name == current_ + "_bucket";
        if (is_histogram ? !is_part && !is_bucket : name != current_ && !(is_summary && is_part))
            refuse(line, "another family's sample");
        const std::string labels = sorted_labels(inside, line);
        if (is_histogram && (labels.find("le=\"") != std::string::npos) != is_bucket)
            refuse(line, "a bound out of place");
        const bool has_quantile = labels.find("quantile=\"") != std::string::npos;
        if (has_quantile != (is_summary && !is_part)) refuse(line, "a quantile out of place");
        const std::string series = labels.empty() ? name : name + "{" + labels + "}";
        if (!family.samples.emplace(series, number(value, line)).second)
            refuse(line, "a series twice");
    }
    std::string current_;
};

}  // namespace

std::map<std::string, MetricFamily> read_metrics(const std::string& text) {
    if (!text.empty() && text.back() != '\n') refuse(text, "the last line has no end");
    Reader reader;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        reader.take(line);
    return reader.families;
}

}  // namespace stormcellar::daemon

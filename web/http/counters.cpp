#include "web/http/counters.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::web {
namespace {

// Returns true if a path is the prefix or lies below it, by whole segments.
bool lies_below(std::string_view path, std::string_view prefix) {
    if (!path.starts_with(prefix)) return false;
    return path.size() == prefix.size() || prefix.ends_with('/') || path[prefix.size()] == '/';
}

// Prefixes come from the program, yet a quotation mark in one must not break the text.
std::string label_text(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        if (letter == '\\' || letter == '"') result += '\\';
        result += letter == '\n' ? ' ' : letter;
    }
    return result;
}

std::string metric_number(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
    return fmt::format("{}", value);
}

void begin_family(std::string& text, std::string_view name, std::string_view type,
                  std::string_view help) {
    text += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
}

}  // namespace

void Counters::add_door(std::string prefix) {
    doors_.emplace_back().prefix = std::move(prefix);
}

void Counters::add_gauge(std::string name, std::string help, std::function<double()> value,
                         const Fields& labels) {
    std::string text;
    for (const auto& [label, content] : labels)
        text += fmt::format("{}{}=\"{}\"", text.empty() ? "{" : ",", label, label_text(content));
    if (!text.empty()) text += '}';
    functions_.push_back(
        {std::move(name), std::move(help), std::move(text), "gauge", std::move(value)});
}

void Counters::add_counter(std::string name, std::string help, std::function<double()> value) {
    functions_.push_back({std::move(name), std::move(help), {}, "counter", std::move(value)});
}

Counters::PerDoor& Counters::door_of(const Request* request) {
    if (request == nullptr) return unread_;
    PerDoor* longest = &other_;
    std::size_t length = 0;
    for (PerDoor& door : doors_) {
        // "/" is the index page alone: what no door knows must not hide among its requests.
        const bool fits =
            door.prefix == "/" ? request->path == "/" : lies_below(request->path, door.prefix);
        if (fits && door.prefix.size() > length) {
            longest = &door;
            length = door.prefix.size();
        }
    }
    return *longest;
}

void Counters::count(const Served& served) {
    PerDoor& door = door_of(served.request);
    const auto status = std::find(counted_statuses.begin(), counted_statuses.end(), served.status) -
                        counted_statuses.begin();
    const double seconds = std::max(served.seconds.count(), 0.0);
    const auto bucket = std::lower_bound(counted_seconds.begin(), counted_seconds.end(), seconds) -
                        counted_seconds.begin();
    ++door.statuses[static_cast<std::size_t>(status)];
    ++door.buckets[static_cast<std::size_t>(bucket)];
    door.bytes += served.bytes;
    door.microseconds += static_cast<std::uint64_t>(std::llround(seconds * 1e6));
}

std::vector<const Counters::PerDoor*> Counters::all_doors() const {
    std::vector<const PerDoor*> doors;
    for (const PerDoor& door : doors_)
        doors.push_back(&door);
    doors.push_back(&other_);
    doors.push_back(&unread_);
    return doors;
}

std::string Counters::text() const {
    std::string text;
    const auto doors = all_doors();
    begin_family(text, "stormcellar_web_requests_total", "counter",
                 "Answers by door and status; 0 stands for all other statuses.");
    for (const PerDoor* door : doors) {
        for (std::size_t i = 0; i <= counted_statuses.size(); ++i) {
            const std::uint64_t count = door->statuses[i];
            if (count == 0) continue;
            text += fmt::format("stormcellar_web_requests_total{{door=\"{}\",status=\"{}\"}} {}\n",
                                label_text(door->prefix),
                                i < counted_statuses.size() ? counted_statuses[i] : 0, count);
        }
    }
    begin_family(text, "stormcellar_web_answer_bytes_total", "counter",
                 "Bytes of the bodies of answers by door, without event streams.");
    for (const PerDoor* door : doors) {
        text += fmt::format("stormcellar_web_answer_bytes_total{{door=\"{}\"}} {}\n",
                            label_text(door->prefix), door->bytes.load());
    }
    begin_family(text, "stormcellar_web_answer_seconds", "histogram",
                 "Seconds from a request to its answer by door, without the time of sending.");
    for (const PerDoor* door : doors) {
        const std::string label = label_text(door->prefix);
        std::uint64_t count = 0;
        for (std::size_t i = 0; i <= counted_seconds.size(); ++i) {
            count += door->buckets[i];
            text += fmt::format(
                "stormcellar_web_answer_seconds_bucket{{door=\"{}\",le=\"{}\"}} {}\n", label,
                i < counted_seconds.size() ? metric_number(counted_seconds[i]) : "+Inf", count);
        }
        const double sum = static_cast<double>(door->microseconds.load()) / 1e6;
        text += fmt::format("stormcellar_web_answer_seconds_sum{{door=\"{}\"}} {}\n", label,
                            metric_number(sum));
        text +=
            fmt::format("stormcellar_web_answer_seconds_count{{door=\"{}\"}} {}\n", label, count);
    }
    for (const Function& function : functions_) {
        begin_family(text, function.name, function.type, function.help);
        text += fmt::format("{}{} {}\n", function.name, function.labels,
                            metric_number(function.value()));
    }
    return text;
}

}  // namespace stormcellar::web

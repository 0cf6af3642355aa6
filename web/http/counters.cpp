#include "web/http/counters.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace stormcellar::web {
namespace {

// Returns true if the path is the prefix, or below it by whole segments.
bool lies_below(std::string_view path, std::string_view prefix) {
    if (!path.starts_with(prefix)) return false;
    return path.size() == prefix.size() || prefix.ends_with('/') || path[prefix.size()] == '/';
}

}  // namespace

void Counters::add_door(std::string prefix) {
    doors_.emplace_back().prefix = std::move(prefix);
}

void Counters::add_gauge(std::string name, std::string help, std::function<double()> value,
                         Fields labels) {
    functions_.push_back({std::move(name), std::move(help), std::move(labels),
                          MetricsWriter::Type::gauge, std::move(value)});
}

void Counters::add_counter(std::string name, std::string help, std::function<double()> value) {
    functions_.push_back(
        {std::move(name), std::move(help), {}, MetricsWriter::Type::counter, std::move(value)});
}

Counters::PerDoor& Counters::door_of(const Request* request) {
    if (request == nullptr) return unread_;
    PerDoor* longest = &other_;
    std::size_t length = 0;
    for (PerDoor& door : doors_) {
        // The door "/" counts only requests for the index page. Requests for unknown paths count as
        // "other".
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
    using Type = MetricsWriter::Type;
    MetricsWriter metrics;
    const auto doors = all_doors();
    metrics.family("stormcellar_web_requests_total", Type::counter,
                   "Answers by door and status; 0 stands for all other statuses.");
    for (const PerDoor* door : doors) {
        for (std::size_t i = 0; i <= counted_statuses.size(); ++i) {
            const std::uint64_t count = door->statuses[i];
            if (count == 0) continue;
            const unsigned status = i < counted_statuses.size() ? counted_statuses[i] : 0;
            metrics.sample(count, {{"door", door->prefix}, {"status", std::to_string(status)}});
        }
    }
    metrics.family("stormcellar_web_answer_bytes_total", Type::counter,
                   "Bytes of the bodies of answers by door, without event streams.");
    for (const PerDoor* door : doors)
        metrics.sample(door->bytes.load(), {{"door", door->prefix}});
    metrics.family("stormcellar_web_answer_seconds", Type::histogram,
                   "Seconds from a request to its answer by door, without the time of sending.");
    for (const PerDoor* door : doors) {
        const std::vector<std::uint64_t> counts(door->buckets.begin(), door->buckets.end());
        metrics.sample(counted_seconds, counts,
                       static_cast<double>(door->microseconds.load()) / 1e6,
                       {"door", door->prefix});
    }
    for (const Function& function : functions_) {
        metrics.family(function.name, function.type, function.help);
        const std::vector<MetricsWriter::Label> labels(function.labels.begin(),
                                                       function.labels.end());
        metrics.sample(function.value(), labels);
    }
    return metrics.take();
}

}  // namespace stormcellar::web

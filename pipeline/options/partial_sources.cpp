#include "pipeline/options/partial_sources.h"

#include <algorithm>

#include <fmt/ranges.h>

namespace stormcellar::pipeline {
namespace {

// Number of stations that the text names. A picture shows this text, and has no room for more
// names.
constexpr std::size_t most_named = 6;

}  // namespace

std::string LateMachine::text() const {
    std::vector<std::string> named{stations.begin(), stations.end()};
    const std::size_t further = named.size() - std::min(named.size(), most_named);
    named.resize(named.size() - further);
    return fmt::format("{} ({}{}): nothing since {}", name, fmt::join(named, " "),
                       further == 0 ? "" : fmt::format(" and {} more", further),
                       format_utc(std::chrono::floor<std::chrono::seconds>(newest)));
}

void PartialSources::brought(const std::string& machine, const std::string& domain,
                             level2::Moment moment, const std::string& station, UtcTime middle) {
    const MutexLock lock(mutex_);
    Brought& brought = mosaics_[{domain, moment}][machine];
    brought.newest = std::max(brought.newest, middle);
    brought.stations.insert(station);
}

std::vector<LateMachine> PartialSources::late_for(const std::string& domain, level2::Moment moment,
                                                  UtcTime instant) const {
    const MutexLock lock(mutex_);
    std::vector<LateMachine> late;
    const auto mosaic = mosaics_.find({domain, moment});
    if (mosaic == mosaics_.end()) return late;
    std::set<std::string> current;
    for (const auto& [machine, brought] : mosaic->second) {
        if (instant - brought.newest > late_after_) {
            late.push_back({machine, brought.stations, brought.newest});
        } else {
            current.insert(brought.stations.begin(), brought.stations.end());
        }
    }
    for (LateMachine& machine : late) {
        std::erase_if(machine.stations,
                      [&](const std::string& station) { return current.contains(station); });
    }
    std::erase_if(late, [](const LateMachine& machine) { return machine.stations.empty(); });
    return late;
}

std::optional<UtcTime> PartialSources::newest_of(const std::string& machine) const {
    const MutexLock lock(mutex_);
    std::optional<UtcTime> newest;
    for (const auto& [mosaic, machines] : mosaics_) {
        const auto brought = machines.find(machine);
        if (brought != machines.end())
            newest = std::max(newest.value_or(brought->second.newest), brought->second.newest);
    }
    return newest;
}

}  // namespace stormcellar::pipeline

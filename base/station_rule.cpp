#include "stormcellar/base/station_rule.h"

#include "stormcellar/base/station_table.h"

namespace stormcellar {

StationRule StationRule::any(std::size_t most_further) {
    StationRule rule;
    rule.kind_ = Kind::any;
    rule.most_further_ = most_further;
    return rule;
}

StationRule StationRule::listed(const std::vector<std::string>& stations) {
    StationRule rule;
    rule.kind_ = Kind::listed;
    for (const std::string& station : stations)
        if (is_icao(station)) rule.listed_.insert(station);
    return rule;
}

StationRule::StationRule(const StationRule& other)
    : kind_(other.kind_), most_further_(other.most_further_), listed_(other.listed_) {
    const MutexLock lock(other.mutex_);
    further_ = other.further_;
}

StationRule& StationRule::operator=(const StationRule& other) {
    if (this == &other) return *this;
    kind_ = other.kind_;
    most_further_ = other.most_further_;
    listed_ = other.listed_;
    const std::vector<std::string> further = other.further();
    const MutexLock lock(mutex_);
    further_ = {further.begin(), further.end()};
    return *this;
}

bool StationRule::knows(std::string_view station) const {
    if (kind_ == Kind::listed) return listed_.contains(station);
    if (find_station(station)) return true;
    const MutexLock lock(mutex_);
    return further_.contains(station);
}

bool StationRule::admits(std::string_view station) {
    if (knows(station)) return true;
    if (kind_ != Kind::any || !is_icao(station)) return false;
    const MutexLock lock(mutex_);
    if (further_.contains(station)) return true;
    if (further_.size() >= most_further_) return false;
    further_.emplace(station);
    return true;
}

std::vector<std::string> StationRule::further() const {
    const MutexLock lock(mutex_);
    return {further_.begin(), further_.end()};
}

bool StationRule::operator==(const StationRule& other) const {
    return kind_ == other.kind_ && most_further_ == other.most_further_ && listed_ == other.listed_;
}

}  // namespace stormcellar

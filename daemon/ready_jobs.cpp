#include "daemon/ready_jobs.h"

namespace stormcellar::daemon {

ReadyJobs::Rank ReadyJobs::rank_of(const Key& key) {
    if (key.urgency == Urgency::live && key.is_begun) {
        return {false, key.newest_ns, key.sequence};
    }
    return {true, -key.newest_ns, key.sequence};
}

void ReadyJobs::give_turn(const std::string& name, Station& station) {
    station.turn = next_turn_++;
    turns_.emplace(station.turn, name);
}

void ReadyJobs::add(const Key& key, void* job) {
    if (key.urgency == Urgency::backlog) {
        count_ += backlog_.emplace(rank_of(key), job).second ? 1 : 0;
        return;
    }
    Station& station = stations_[key.station];
    if (station.jobs.empty()) give_turn(key.station, station);
    count_ += station.jobs.emplace(rank_of(key), job).second ? 1 : 0;
}

void ReadyJobs::replace(const Key& old, const Key& key, void* job) {
    add(key, job);
    remove(old);
}

void ReadyJobs::remove(const Key& key) {
    if (key.urgency == Urgency::backlog) {
        count_ -= backlog_.erase(rank_of(key));
        return;
    }
    const auto station = stations_.find(key.station);
    if (station == stations_.end()) return;
    count_ -= station->second.jobs.erase(rank_of(key));
    if (!station->second.jobs.empty()) return;
    turns_.erase(station->second.turn);
    stations_.erase(station);
}

void* ReadyJobs::take_next() {
    if (count_ == 0) return nullptr;
    --count_;
    if (turns_.empty()) {
        void* job = backlog_.begin()->second;
        backlog_.erase(backlog_.begin());
        return job;
    }
    const auto station = stations_.find(turns_.begin()->second);
    turns_.erase(turns_.begin());
    auto& jobs = station->second.jobs;
    void* job = jobs.begin()->second;
    jobs.erase(jobs.begin());
    if (jobs.empty()) {
        stations_.erase(station);
    } else {
        give_turn(station->first, station->second);
    }
    return job;
}

}  // namespace stormcellar::daemon

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
        count_ += backlog_of(key).emplace(rank_of(key), OldJob{job, key.station}).second ? 1 : 0;
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
        count_ -= backlog_of(key).erase(rank_of(key));
        return;
    }
    const auto station = stations_.find(key.station);
    if (station == stations_.end()) return;
    count_ -= station->second.jobs.erase(rank_of(key));
    if (!station->second.jobs.empty()) return;
    turns_.erase(station->second.turn);
    stations_.erase(station);
}

void* ReadyJobs::take_old(Backlog& backlog, const MayBegin& may_begin) {
    int looked_at = 0;
    for (auto at = backlog.begin(); at != backlog.end() && looked_at < most_looked_at;
         ++at, ++looked_at) {
        if (may_begin && !may_begin(at->second.station)) continue;
        void* job = at->second.job;
        backlog.erase(at);
        --count_;
        return job;
    }
    return nullptr;
}

void* ReadyJobs::take_next(const MayBegin& may_begin) {
    for (auto turn = turns_.begin(); turn != turns_.end(); ++turn) {
        if (may_begin && !may_begin(turn->second)) continue;
        const auto station = stations_.find(turn->second);
        turns_.erase(turn);
        auto& jobs = station->second.jobs;
        void* job = jobs.begin()->second;
        jobs.erase(jobs.begin());
        --count_;
        if (jobs.empty()) {
            stations_.erase(station);
        } else {
            give_turn(station->first, station->second);
        }
        return job;
    }
    if (void* job = take_old(backlog_, may_begin)) return job;
    return take_old(others_backlog_, may_begin);
}

}  // namespace stormcellar::daemon

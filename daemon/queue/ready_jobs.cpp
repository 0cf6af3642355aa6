#include "daemon/queue/ready_jobs.h"

namespace stormcellar::daemon {

ReadyJobs::Class ReadyJobs::class_of(const Key& key) {
    if (key.station.empty()) return Class::others;
    if (key.is_begun) return Class::going_on;
    return key.is_told ? Class::fresh : Class::found;
}

ReadyJobs::Rank ReadyJobs::rank_of(const Key& key) {
    const bool is_oldest_first = key.urgency == Urgency::live && class_of(key) == Class::going_on;
    return {is_oldest_first ? key.newest_ns : -key.newest_ns, key.sequence};
}

void ReadyJobs::give_turn(Turns& turns, const std::string& name, Station& station) {
    station.turn = next_turn_++;
    turns.turns.emplace(station.turn, name);
}

void ReadyJobs::add(const Key& key, void* job) {
    if (key.urgency == Urgency::backlog) {
        count_ += backlog_of(key).emplace(rank_of(key), OldJob{job, key.station}).second ? 1 : 0;
        return;
    }
    Turns& turns = turns_for(key);
    Station& station = turns.stations[key.station];
    if (station.jobs.empty()) give_turn(turns, key.station, station);
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
    Turns& turns = turns_for(key);
    const auto station = turns.stations.find(key.station);
    if (station == turns.stations.end()) return;
    count_ -= station->second.jobs.erase(rank_of(key));
    if (!station->second.jobs.empty()) return;
    turns.turns.erase(station->second.turn);
    turns.stations.erase(station);
}

void* ReadyJobs::take_live(Turns& turns, const MayBegin& may_begin) {
    for (auto turn = turns.turns.begin(); turn != turns.turns.end(); ++turn) {
        if (may_begin && !may_begin(turn->second)) continue;
        const auto station = turns.stations.find(turn->second);
        turns.turns.erase(turn);
        auto& jobs = station->second.jobs;
        void* job = jobs.begin()->second;
        jobs.erase(jobs.begin());
        --count_;
        if (jobs.empty()) {
            turns.stations.erase(station);
        } else {
            give_turn(turns, station->first, station->second);
        }
        return job;
    }
    return nullptr;
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

// Takes a live job from the first class that has turns left and a job that may begin.
void* ReadyJobs::take_of_round(const MayBegin& may_begin) {
    for (Turns& turns : live_) {
        if (turns.left == 0) continue;
        void* job = take_live(turns, may_begin);
        if (job == nullptr) continue;
        --turns.left;
        return job;
    }
    return nullptr;
}

void* ReadyJobs::take_any_live(const MayBegin& may_begin) {
    if (void* job = take_of_round(may_begin)) return job;
    for (std::size_t i = 0; i < live_.size(); ++i)
        live_.at(i).left = turns_a_round.at(i);
    return take_of_round(may_begin);
}

void* ReadyJobs::take_next(const MayBegin& may_begin) {
    if (live_since_old_ < live_between_old) {
        if (void* job = take_any_live(may_begin)) {
            live_since_old_ += backlog_.empty() ? 0 : 1;
            return job;
        }
    }
    live_since_old_ = 0;
    if (void* job = take_old(backlog_, may_begin)) return job;
    if (void* job = take_any_live(may_begin)) return job;
    return take_old(others_backlog_, may_begin);
}

}  // namespace stormcellar::daemon

#include "daemon/queue/schedule.h"

#include <algorithm>
#include <utility>

namespace stormcellar::daemon {
namespace {

// Time to wait if every ready job is of a station that may not use another worker now.
constexpr std::chrono::milliseconds look_at_shares{50};

}  // namespace

void Schedule::merge(Job& into, const Job& job) {
    into.finish_as_is = into.finish_as_is && job.finish_as_is;
    into.closed_at =
        std::max(into.closed_at, job.closed_at);  // an empty optional is less than any time
    into.newest_ns = std::max(into.newest_ns, job.newest_ns);
    into.not_before = std::max(into.not_before, job.not_before);
    into.failures = std::max(into.failures, job.failures);
    into.urgency = std::max(into.urgency, job.urgency);
    into.is_begun = into.is_begun || job.is_begun;
    into.is_registered = into.is_registered || job.is_registered;
    if (into.station.empty()) into.station = job.station;
}

ReadyJobs::Key Schedule::key_of(const Entry& entry) {
    return {entry.job.urgency, entry.job.is_begun, entry.job.newest_ns,
            entry.sequence,    entry.job.station,  entry.job.closed_at.has_value()};
}

// Queues a job. A job with a `not_before` becomes ready at that time.
void Schedule::enqueue(Entry& entry) {
    entry.running = false;
    entry.sequence = next_sequence_++;
    if (entry.job.not_before == SteadyTime{}) {
        ready_.add(key_of(entry), &entry);
    } else {
        delayed_[{entry.job.not_before, entry.sequence}] = &entry;
    }
    waiting_.emplace(entry.place, &entry);
    if (!entry.job.is_registered) unregistered_.emplace(entry.place, &entry);
    claim(entry);
    shares_looked_at_ = SteadyTime{};
}

Schedule::Worth Schedule::worth_of(const Job& job, std::uint64_t place) {
    int kind = 0;
    if (job.urgency == Urgency::live) kind = job.is_begun ? 3 : job.closed_at ? 2 : 1;
    return {kind, job.newest_ns, ~place};  // among equal jobs, the last is worth least
}

void Schedule::claim(const Entry& entry) {
    if (!entry.is_retrying) claims_[entry.job.station].insert(worth_of(entry.job, entry.place));
}

void Schedule::unclaim(const Entry& entry) {
    const auto own = claims_.find(entry.job.station);
    if (own == claims_.end()) return;
    own->second.erase(worth_of(entry.job, entry.place));
    if (own->second.empty()) claims_.erase(own);
}

void Schedule::drop_waiting(Entry& entry) {
    if (entry.job.not_before == SteadyTime{}) {
        ready_.remove(key_of(entry));
    } else {
        delayed_.erase({entry.job.not_before, entry.sequence});
    }
    run(entry);
    displaced_.push_back(entry.job.path);
    entries_.erase(entry.job.path.native());
}

bool Schedule::make_room_for(const Job& job) {
    const auto largest = std::max_element(
        claims_.begin(), claims_.end(),
        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    if (largest == claims_.end()) return false;
    const auto own = claims_.find(job.station);
    const std::size_t own_count = own == claims_.end() ? 0 : own->second.size();
    const bool has_fewer = largest->second.size() > own_count + 1;
    if (!has_fewer && own == claims_.end()) return false;
    const Worth least = *(has_fewer ? largest : own)->second.begin();
    if (!has_fewer && worth_of(job, next_place_) <= least) return false;
    drop_waiting(*waiting_.at(~std::get<2>(least)));
    return true;
}

// Handles a file that is offered again while its job waits.
void Schedule::wait_again(Entry& entry, const Job& job) {
    const bool was_ready = entry.job.not_before == SteadyTime{};
    const ReadyJobs::Key old = key_of(entry);
    const SteadyTime old_time = entry.job.not_before;
    unclaim(entry);
    merge(entry.job, job);
    claim(entry);
    entry.sequence = next_sequence_++;
    const bool is_ready = entry.job.not_before == SteadyTime{};
    if (was_ready && is_ready) {
        ready_.replace(old, key_of(entry), &entry);
    } else if (was_ready) {
        ready_.remove(old);
    } else {
        delayed_.erase({old_time, old.sequence});
    }
    if (!is_ready) delayed_[{entry.job.not_before, entry.sequence}] = &entry;
    if (entry.job.is_registered) unregistered_.erase(entry.place);
    shares_looked_at_ = SteadyTime{};
}

Offered Schedule::offer(Job job, SteadyTime now) {
    if (const auto found = entries_.find(job.path.native()); found != entries_.end()) {
        Entry& entry = found->second;
        if (!entry.running) {
            wait_again(entry, job);
        } else if (entry.again) {
            merge(*entry.again, job);
        } else {
            entry.again = std::move(job);
            entry.again_at = now;
        }
        return Offered::merged;
    }
    if (entries_.size() - retrying_ >= limit_ && !make_room_for(job)) return Offered::refused;
    Entry& entry = entries_[job.path.native()];
    entry.job = std::move(job);
    entry.offered_at = now;
    entry.place = next_place_++;
    enqueue(entry);
    return Offered::queued;
}

// Sets the time since which a job counts as waiting. For a delayed job, this is the time from which
// it may run.
void Schedule::wait_since(Entry& entry, SteadyTime time) {
    const bool was_unregistered = unregistered_.erase(entry.place) > 0;
    waiting_.erase(entry.place);
    unclaim(entry);
    entry.offered_at = time;
    entry.place = next_place_++;
    waiting_.emplace(entry.place, &entry);
    claim(entry);
    if (was_unregistered) unregistered_.emplace(entry.place, &entry);
}

void Schedule::run(Entry& entry) {
    entry.running = true;
    unclaim(entry);
    retrying_ -= entry.is_retrying ? 1 : 0;
    waiting_.erase(entry.place);
    unregistered_.erase(entry.place);
}

std::optional<Job> Schedule::next(SteadyTime now) {
    if (now < held_until_) return std::nullopt;
    while (!delayed_.empty() && delayed_.begin()->first.first <= now) {
        Entry& entry = *delayed_.begin()->second;
        delayed_.erase(delayed_.begin());
        retrying_ -= entry.is_retrying ? 1 : 0;
        entry.is_retrying = false;
        if (entry.job.not_before > entry.offered_at) wait_since(entry, entry.job.not_before);
        entry.job.not_before = SteadyTime{};
        ready_.add(key_of(entry), &entry);
    }
    auto* entry = static_cast<Entry*>(ready_.take_next(
        [&](const std::string& station) { return shares_.may_begin(station, now); }));
    if (entry == nullptr) {
        shares_looked_at_ = now + look_at_shares;
        return std::nullopt;
    }
    run(*entry);
    entry->has_worker = true;
    if (entry->job.urgency == Urgency::live) last_wait_ = now - entry->offered_at;
    shares_.begun(entry->job.station, now);
    return entry->job;
}

void Schedule::worked(const std::filesystem::path& path, SteadyTime::duration took, SteadyTime now,
                      bool is_good) {
    const auto found = entries_.find(path.native());
    if (found == entries_.end() || !std::exchange(found->second.has_worker, false)) return;
    shares_.ended(found->second.job.station, took, is_good, now);
    shares_looked_at_ = SteadyTime{};
}

std::optional<Job> Schedule::next_unregistered(SteadyTime now) {
    if (now < held_until_ || unregistered_.empty()) return std::nullopt;
    Entry& entry = *unregistered_.begin()->second;
    if (entry.offered_at + register_after > now) return std::nullopt;
    if (entry.job.not_before == SteadyTime{}) {
        ready_.remove(key_of(entry));
    } else {
        delayed_.erase({entry.job.not_before, entry.sequence});
    }
    run(entry);
    return entry.job;
}

void Schedule::registered(const std::filesystem::path& path) {
    const auto found = entries_.find(path.native());
    if (found == entries_.end()) return;
    Entry& entry = found->second;
    if (entry.again) merge(entry.job, *std::exchange(entry.again, std::nullopt));
    entry.job.is_registered = true;
    retrying_ += entry.is_retrying ? 1 : 0;
    enqueue(entry);
}

void Schedule::finished(const std::filesystem::path& path, SteadyTime again_not_before) {
    const auto found = entries_.find(path.native());
    if (found == entries_.end()) return;
    Entry& entry = found->second;
    if (!entry.again) {
        entries_.erase(found);
        return;
    }
    entry.job = *std::exchange(entry.again, std::nullopt);
    entry.job.not_before = std::max(entry.job.not_before, again_not_before);
    entry.offered_at = entry.again_at;
    entry.place = next_place_++;
    enqueue(entry);
}

bool Schedule::retry(Job job, SteadyTime now) {
    const auto found = entries_.find(job.path.native());
    if (found == entries_.end()) return true;
    if (retrying_ >= retry_limit()) {
        entries_.erase(found);
        return false;
    }
    Entry& entry = found->second;
    entry.job = std::move(job);
    ++entry.job.failures;
    if (entry.again) merge(entry.job, *std::exchange(entry.again, std::nullopt));
    entry.job.not_before = now + retry_delay(entry.job.failures);
    entry.is_retrying = true;
    ++retrying_;
    enqueue(entry);
    return true;
}

std::optional<SteadyTime> Schedule::next_time() const {
    std::optional<SteadyTime> time;
    if (!ready_.empty()) {
        time = shares_looked_at_;
        if (!delayed_.empty()) time = std::min(*time, delayed_.begin()->first.first);
    } else if (!delayed_.empty()) {
        time = delayed_.begin()->first.first;
    }
    if (time) time = std::max(*time, held_until_);
    return time;
}

std::optional<SteadyTime> Schedule::next_unregistered_time() const {
    if (unregistered_.empty()) return std::nullopt;
    return std::max(unregistered_.begin()->second->offered_at + register_after, held_until_);
}

std::optional<SteadyTime> Schedule::oldest_offer() const {
    for (const auto& [place, entry] : waiting_) {
        if (entry->job.not_before == SteadyTime{}) return entry->offered_at;
    }
    return std::nullopt;
}

std::chrono::seconds Schedule::retry_delay(int failures) {
    constexpr int longest_s = 60;
    if (failures > 6) return std::chrono::seconds{longest_s};
    return std::chrono::seconds{std::min(longest_s, 1 << std::max(0, failures - 1))};
}

}  // namespace stormcellar::daemon

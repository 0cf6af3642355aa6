#include "daemon/schedule.h"

#include <algorithm>
#include <utility>

namespace stormcellar::daemon {

void Schedule::merge(Job& into, const Job& job) {
    into.finish_partial = into.finish_partial && job.finish_partial;
    into.closed_at = std::max(into.closed_at, job.closed_at);  // none is less than any time
    into.newest_ns = std::max(into.newest_ns, job.newest_ns);
    into.not_before = std::max(into.not_before, job.not_before);
    into.failures = std::max(into.failures, job.failures);
    into.urgency = std::max(into.urgency, job.urgency);
    into.is_begun = into.is_begun || job.is_begun;
    into.is_registered = into.is_registered || job.is_registered;
    if (into.station.empty()) into.station = job.station;
}

ReadyJobs::Key Schedule::key_of(const Entry& entry) {
    return {entry.job.urgency, entry.job.is_begun, entry.job.newest_ns, entry.sequence,
            entry.job.station};
}

// A job with a time to wait for starts among the delayed, and joins the ready when it has come.
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
}

// Offered again while it waits.
void Schedule::wait_again(Entry& entry, const Job& job) {
    const bool was_ready = entry.job.not_before == SteadyTime{};
    const ReadyJobs::Key old = key_of(entry);
    const SteadyTime old_time = entry.job.not_before;
    merge(entry.job, job);
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
    if (entries_.size() >= limit_) return Offered::refused;
    Entry& entry = entries_[job.path.native()];
    entry.job = std::move(job);
    entry.offered_at = now;
    entry.place = next_place_++;
    enqueue(entry);
    return Offered::queued;
}

// It waits for us since then, and not since it first failed.
void Schedule::wait_since(Entry& entry, SteadyTime time) {
    const bool was_unregistered = unregistered_.erase(entry.place) > 0;
    waiting_.erase(entry.place);
    entry.offered_at = time;
    entry.place = next_place_++;
    waiting_.emplace(entry.place, &entry);
    if (was_unregistered) unregistered_.emplace(entry.place, &entry);
}

void Schedule::run(Entry& entry) {
    entry.running = true;
    waiting_.erase(entry.place);
    unregistered_.erase(entry.place);
}

std::optional<Job> Schedule::next(SteadyTime now) {
    if (now < held_until_) return std::nullopt;
    while (!delayed_.empty() && delayed_.begin()->first.first <= now) {
        Entry& entry = *delayed_.begin()->second;
        delayed_.erase(delayed_.begin());
        if (entry.job.not_before > entry.offered_at) wait_since(entry, entry.job.not_before);
        entry.job.not_before = SteadyTime{};
        ready_.add(key_of(entry), &entry);
    }
    auto* entry = static_cast<Entry*>(ready_.take_next());
    if (entry == nullptr) return std::nullopt;
    run(*entry);
    return entry->job;
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

void Schedule::retry(Job job, SteadyTime now) {
    const auto found = entries_.find(job.path.native());
    if (found == entries_.end()) return;
    Entry& entry = found->second;
    entry.job = std::move(job);
    ++entry.job.failures;
    if (entry.again) merge(entry.job, *std::exchange(entry.again, std::nullopt));
    entry.job.not_before = now + retry_delay(entry.job.failures);
    enqueue(entry);
}

std::optional<SteadyTime> Schedule::next_time() const {
    std::optional<SteadyTime> time;
    if (!ready_.empty()) {
        time = SteadyTime{};
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

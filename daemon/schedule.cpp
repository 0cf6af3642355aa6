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
}

// A job with a time to wait for starts among the delayed, and joins the ready when it has come.
void Schedule::enqueue(Entry& entry) {
    entry.running = false;
    entry.sequence = next_sequence_++;
    if (entry.job.not_before == SteadyTime{}) {
        ready_[{entry.job.newest_ns, entry.sequence}] = &entry;
    } else {
        delayed_[{entry.job.not_before, entry.sequence}] = &entry;
    }
}

void Schedule::dequeue(const Entry& entry) {
    ready_.erase({entry.job.newest_ns, entry.sequence});
    delayed_.erase({entry.job.not_before, entry.sequence});
}

Offered Schedule::offer(Job job) {
    if (const auto found = entries_.find(job.path.native()); found != entries_.end()) {
        Entry& entry = found->second;
        if (entry.running) {
            if (entry.again) {
                merge(*entry.again, job);
            } else {
                entry.again = std::move(job);
            }
        } else {
            dequeue(entry);
            merge(entry.job, job);
            enqueue(entry);
        }
        return Offered::merged;
    }
    if (entries_.size() >= limit_) return Offered::refused;
    Entry& entry = entries_[job.path.native()];
    entry.job = std::move(job);
    enqueue(entry);
    return Offered::queued;
}

std::optional<Job> Schedule::next(SteadyTime now) {
    if (now < held_until_) return std::nullopt;
    while (!delayed_.empty() && delayed_.begin()->first.first <= now) {
        Entry& entry = *delayed_.begin()->second;
        delayed_.erase(delayed_.begin());
        entry.job.not_before = SteadyTime{};
        ready_[{entry.job.newest_ns, entry.sequence}] = &entry;
    }
    if (ready_.empty()) return std::nullopt;
    Entry& entry = *ready_.begin()->second;
    ready_.erase(ready_.begin());
    entry.running = true;
    return entry.job;
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

std::chrono::seconds Schedule::retry_delay(int failures) {
    constexpr int longest_s = 60;
    if (failures > 6) return std::chrono::seconds{longest_s};
    return std::chrono::seconds{std::min(longest_s, 1 << std::max(0, failures - 1))};
}

}  // namespace stormcellar::daemon

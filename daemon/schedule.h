// daemon/schedule.h -- which file is looked at next.
//
// One entry a path: what is offered again while it waits is merged, what is offered again while it
// runs is looked at once more afterwards. Newest first, by the time at which the file was closed
// (its modification time when nobody saw the close), so that a backlog never delays what has just
// come. A file that could not be stored waits, longer each time, and is never dropped.
// Memory is bounded by `limit` entries: beyond it an offer is refused, and the caller finds the
// file again by a scan once there is room. Pure bookkeeping: the caller says what time it is.
// Thread contract: one thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

namespace stormcellar::daemon {

using SteadyTime = std::chrono::steady_clock::time_point;

struct Job {
    std::filesystem::path path;
    bool finish_partial = false;          // the file was quiet for long enough
    std::optional<SteadyTime> closed_at;  // the last close that was seen; none: found by a scan
    std::int64_t newest_ns = 0;           // since the epoch; decides the order
    SteadyTime not_before{};
    int failures = 0;  // how often it could not be stored
};

enum class Offered { queued, merged, refused };

class Schedule {
  public:
    explicit Schedule(std::size_t limit) : limit_(limit) {}

    // Merged: the later close and time count, and finish_partial only when both ask for it (a new
    // close means that the file was not quiet).
    Offered offer(Job job);
    // The newest job that may run now; it counts as running until finished() or retry().
    std::optional<Job> next(SteadyTime now);
    // What was offered again meanwhile waits once more, not to run before `again_not_before`.
    void finished(const std::filesystem::path& path, SteadyTime again_not_before = {});
    // Puts a running job back, not to run before now + retry_delay(its failures).
    void retry(Job job, SteadyTime now);
    // No job runs before this time (a full disk concerns them all).
    void hold_until(SteadyTime time) { held_until_ = time; }

    // When the next waiting job may run; none when nothing waits. May lie in the past.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    [[nodiscard]] std::size_t waiting_count() const { return ready_.size() + delayed_.size(); }
    [[nodiscard]] std::size_t running_count() const { return entries_.size() - waiting_count(); }
    [[nodiscard]] std::size_t limit() const { return limit_; }

    // 1 s doubling to 60 s.
    [[nodiscard]] static std::chrono::seconds retry_delay(int failures);

  private:
    struct Entry {
        Job job;
        bool running = false;
        std::optional<Job> again;  // offered while it ran
        std::uint64_t sequence = 0;
    };
    // Newest first, and first come first served among equals.
    struct ReadyKey {
        std::int64_t newest_ns;
        std::uint64_t sequence;
        bool operator<(const ReadyKey& other) const {
            if (newest_ns != other.newest_ns) return newest_ns > other.newest_ns;
            return sequence < other.sequence;
        }
    };
    using DelayedKey = std::pair<SteadyTime, std::uint64_t>;

    void enqueue(Entry& entry);
    void dequeue(const Entry& entry);
    static void merge(Job& into, const Job& job);

    std::size_t limit_;
    std::uint64_t next_sequence_ = 0;
    SteadyTime held_until_{};
    std::unordered_map<std::string, Entry> entries_;
    std::map<ReadyKey, Entry*> ready_;
    std::map<DelayedKey, Entry*> delayed_;
};

}  // namespace stormcellar::daemon

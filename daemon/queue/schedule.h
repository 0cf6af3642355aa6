// daemon/queue/schedule.h -- which file is looked at next.
//
// One entry a path: what is offered again while it waits is merged, what is offered again while it
// runs is looked at once more afterwards. In the order of ready_jobs.h, so that a backlog never
// delays what has just come, nor one station another (work_shares.h). A file that could not be
// stored waits, longer each time, beside the queue: it takes no place there from files that come.
// What has waited for `register_after` is to be written into the catalog without being read
// (next_unregistered()): however far behind we are, what is there can be asked for.
// Memory is bounded by `limit` entries, and a quarter as many of those to be tried again. At the
// bound what comes takes the place of what is worth least of the station that has most, where it
// has fewer itself, or is worth more than something of its own; else it is refused. Worth least is
// what would be served last: the backlog, then what a look found, then what an event told of, each
// the oldest first, and what goes on after all. The caller finds what had to go again by a scan,
// once there is room. Pure bookkeeping: the caller says what time it is. Thread contract: one
// thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/steady_time.h"
#include "daemon/queue/ready_jobs.h"
#include "daemon/queue/work_shares.h"

namespace stormcellar::daemon {

struct Job {
    std::filesystem::path path;
    bool finish_as_is = false;            // the file was quiet for long enough
    std::optional<SteadyTime> closed_at;  // the last close that was seen; none: found by a scan
    std::int64_t newest_ns = 0;           // since the epoch
    SteadyTime not_before{};
    int failures = 0;  // how often it could not be taken in or stored
    // For its place among the others (ready_jobs.h):
    Urgency urgency = Urgency::backlog;
    bool is_begun = false;
    std::string station;
    bool is_registered = false;  // in the catalog with this state, or one before
};

enum class Offered { queued, merged, refused };

class Schedule {
  public:
    static constexpr std::chrono::seconds register_after{2};

    explicit Schedule(std::size_t limit) : limit_(limit) {}

    // Merged: the later close and time count, and finish_as_is only when both ask for it (a new
    // close means that the file was not quiet).
    Offered offer(Job job, SteadyTime now = {});
    // The first job that may run now; it counts as running until finished() or retry().
    std::optional<Job> next(SteadyTime now);
    // One that is not registered and was offered long enough ago, the longest first; it counts as
    // running until registered().
    std::optional<Job> next_unregistered(SteadyTime now);
    // Puts it back, to be run; whether that succeeded or not it is not asked for again.
    void registered(const std::filesystem::path& path);
    // What was offered again meanwhile waits once more, not to run before `again_not_before`.
    void finished(const std::filesystem::path& path, SteadyTime again_not_before = {});
    // Puts a running job back, not to run before now + retry_delay(its failures). False: too many
    // wait so already, and it is forgotten.
    [[nodiscard]] bool retry(Job job, SteadyTime now);
    // Of a job that next() gave: its worker is free again. Before finished() or retry().
    // `is_good`: something of its station was gridded or shown.
    void worked(const std::filesystem::path& path, SteadyTime::duration took, SteadyTime now,
                bool is_good = false);
    void set_workers(int workers) { shares_.set_workers(workers); }
    // Those that had to give their places to others since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }
    // No job runs before this time (a full disk concerns them all).
    void hold_until(SteadyTime time) { held_until_ = time; }

    // When the next waiting job may run; none when nothing waits. May lie in the past.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // When there is one to be registered; none when all are.
    [[nodiscard]] std::optional<SteadyTime> next_unregistered_time() const;
    // Since when the one waits that has waited for longest, of those that may run.
    [[nodiscard]] std::optional<SteadyTime> oldest_offer() const;
    [[nodiscard]] std::size_t waiting_count() const {
        return ready_.count() + delayed_.size() - retrying_;
    }
    [[nodiscard]] std::size_t running_count() const {
        return entries_.size() - ready_.count() - delayed_.size();
    }
    // Those that failed and wait until they are tried again.
    [[nodiscard]] std::size_t retrying_count() const { return retrying_; }
    [[nodiscard]] std::size_t limit() const { return limit_; }
    [[nodiscard]] std::size_t retry_limit() const { return std::max<std::size_t>(4, limit_ / 4); }

    // 1 s doubling to 60 s.
    [[nodiscard]] static std::chrono::seconds retry_delay(int failures);

  private:
    struct Entry {
        Job job;
        bool running = false;
        bool has_worker = false;   // running, given by next()
        bool is_retrying = false;  // failed, and waits for its time
        std::optional<Job> again;  // offered while it ran
        std::uint64_t sequence = 0;
        SteadyTime offered_at{}, again_at{};
        std::uint64_t place = 0;  // among those that were offered
    };
    using DelayedKey = std::pair<SteadyTime, std::uint64_t>;

    // Of a job among those of its station: least is what gives its place first.
    using Worth = std::tuple<int, std::int64_t, std::uint64_t>;
    static Worth worth_of(const Job& job, std::uint64_t place);
    static ReadyJobs::Key key_of(const Entry& entry);
    void enqueue(Entry& entry);
    void wait_again(Entry& entry, const Job& job);
    void run(Entry& entry);
    void wait_since(Entry& entry, SteadyTime time);
    void claim(const Entry& entry);
    void unclaim(const Entry& entry);
    // False where no station has more than `job`'s own.
    bool make_room_for(const Job& job);
    void drop_waiting(Entry& entry);
    static void merge(Job& into, const Job& job);

    std::size_t limit_;
    std::uint64_t next_sequence_ = 0, next_place_ = 0;
    SteadyTime held_until_{};
    std::unordered_map<std::string, Entry> entries_;
    ReadyJobs ready_;
    std::map<DelayedKey, Entry*> delayed_;
    std::map<std::uint64_t, Entry*> waiting_;       // by place: all that wait
    std::map<std::uint64_t, Entry*> unregistered_;  // the same, those alone
    // Those that wait, but for those to be tried again, by station.
    std::unordered_map<std::string, std::set<Worth>> claims_;
    std::size_t retrying_ = 0;
    WorkShares shares_;
    SteadyTime shares_looked_at_{};  // nothing that is ready may begin before, unless more comes
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon

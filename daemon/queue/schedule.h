// daemon/queue/schedule.h -- which file is ingested next.
//
// There is one entry for each path. A file that is offered again while it waits is merged; one that
// is offered again while it runs is read once more afterwards. Jobs run in the order of
// ready_jobs.h, so that a backlog never delays what has just come, nor one station another
// (work_shares.h). A file that could not be stored waits beside the queue, longer each time, and
// takes no place from files that come. A file that has waited for `register_after` should be
// written into the catalog unread (next_unregistered()), so that the catalog lists it however far
// behind the service is. Memory is bounded by `limit` entries, and a quarter as many that wait to
// be tried again. At the bound a new file replaces the least important entry of the station that
// has most, if its own station has fewer, or an entry of its own station that is less important;
// otherwise it is refused. The entry that would run last is least important: first the backlog,
// then what a scan or poll found, then what an event reported, each oldest first, and last what
// goes on. The caller finds replaced files again by a scan, once there is room. Pure bookkeeping:
// the caller passes the time. Thread contract: one thread.
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
    bool finish_as_is = false;  // the file was quiet for long enough
    std::optional<SteadyTime>
        closed_at;               // the last close that was seen; none: a scan found the file
    std::int64_t newest_ns = 0;  // since the epoch
    SteadyTime not_before{};
    int failures = 0;  // how often the file could not be ingested or stored
    // For its place among the others (ready_jobs.h):
    Urgency urgency = Urgency::backlog;
    bool is_begun = false;
    std::string station;
    bool is_registered = false;  // the catalog has this state of the file, or an earlier one
};

enum class Offered { queued, merged, refused };

class Schedule {
  public:
    static constexpr std::chrono::seconds register_after{2};

    explicit Schedule(std::size_t limit) : limit_(limit) {}

    // A merged job gets the later close and time. It gets finish_as_is only if both jobs have it,
    // because a new close means that the file was not quiet.
    Offered offer(Job job, SteadyTime now = {});
    // The first job that may run now. It counts as running until finished() or retry().
    std::optional<Job> next(SteadyTime now);
    // The job that was offered longest ago and is not registered, if it has waited long enough. It
    // counts as running until registered().
    std::optional<Job> next_unregistered(SteadyTime now);
    // Returns the job to the queue. It is not registered again, whether registering succeeded or
    // not.
    void registered(const std::filesystem::path& path);
    // If the file was offered again meanwhile, it waits once more, and does not run before
    // `again_not_before`.
    void finished(const std::filesystem::path& path, SteadyTime again_not_before = {});
    // Returns a running job to wait until now + retry_delay(its failures). Returns false if too
    // many jobs wait so; then the job is forgotten.
    [[nodiscard]] bool retry(Job job, SteadyTime now);
    // The worker of a job from next() is free again. Call it before finished() or retry().
    // `is_good`: something of its station was gridded or shown.
    void worked(const std::filesystem::path& path, SteadyTime::duration took, SteadyTime now,
                bool is_good = false);
    void set_workers(int workers) { shares_.set_workers(workers); }
    // The files that gave their places to others since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }
    // No job runs before this time (for example because a full disk concerns all jobs).
    void hold_until(SteadyTime time) { held_until_ = time; }

    // When the next waiting job may run; none if nothing waits. May be in the past.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // When a job must be registered; none if all are.
    [[nodiscard]] std::optional<SteadyTime> next_unregistered_time() const;
    // Since when the job waits that has waited longest, among those that may run.
    [[nodiscard]] std::optional<SteadyTime> oldest_offer() const;
    [[nodiscard]] std::size_t waiting_count() const {
        return ready_.count() + delayed_.size() - retrying_;
    }
    [[nodiscard]] std::size_t running_count() const {
        return entries_.size() - ready_.count() - delayed_.size();
    }
    // Jobs that failed and wait to be tried again.
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
        bool is_retrying = false;  // failed, and waits to be tried again
        std::optional<Job> again;  // offered while the job ran
        std::uint64_t sequence = 0;
        SteadyTime offered_at{}, again_at{};
        std::uint64_t place = 0;  // in the order in which jobs were offered
    };
    using DelayedKey = std::pair<SteadyTime, std::uint64_t>;

    // For a job among those of its station: the least one gives its place first.
    using Worth = std::tuple<int, std::int64_t, std::uint64_t>;
    static Worth worth_of(const Job& job, std::uint64_t place);
    static ReadyJobs::Key key_of(const Entry& entry);
    void enqueue(Entry& entry);
    void wait_again(Entry& entry, const Job& job);
    void run(Entry& entry);
    void wait_since(Entry& entry, SteadyTime time);
    void claim(const Entry& entry);
    void unclaim(const Entry& entry);
    // Returns false if no station has more than that of `job`.
    bool make_room_for(const Job& job);
    void drop_waiting(Entry& entry);
    static void merge(Job& into, const Job& job);

    std::size_t limit_;
    std::uint64_t next_sequence_ = 0, next_place_ = 0;
    SteadyTime held_until_{};
    std::unordered_map<std::string, Entry> entries_;
    ReadyJobs ready_;
    std::map<DelayedKey, Entry*> delayed_;
    std::map<std::uint64_t, Entry*> waiting_;       // all waiting jobs, by place
    std::map<std::uint64_t, Entry*> unregistered_;  // the unregistered ones among them
    // The waiting jobs by station, without those that wait to be tried again.
    std::unordered_map<std::string, std::set<Worth>> claims_;
    std::size_t retrying_ = 0;
    WorkShares shares_;
    SteadyTime shares_looked_at_{};  // no ready job may begin before this time, unless more comes
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon

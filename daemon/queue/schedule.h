// daemon/queue/schedule.h -- decides which file is ingested next.
//
// There is one entry for each path. If a file is offered again while it waits, the offer is merged
// with its entry. If it is offered again while its job runs, it is ingested once more afterward.
// ready_jobs.h defines the order, and work_shares.h the limits of a station, so that no backlog
// delays new files and no station delays other stations. A file that could not be stored waits
// outside the queue, longer after each failure, so that it takes no place from files that arrive. A
// file that has waited for `register_after` is registered in the catalog without being read
// (next_unregistered()), so that the catalog lists every file, however far ingest is behind.
//
// Memory is bounded: at most `limit` entries, and a quarter as many files that wait for another
// attempt. At the limit, a new job takes the place of the least valuable job of the station with
// the most jobs, if the new job's station has at least two jobs fewer. Otherwise the new job takes
// the place of a less valuable job of its own station, or is refused. Jobs of the backlog are the
// least valuable. Then come, in rising order, files that a scan found, files that an event
// reported, and volumes that are going on; among equals, the oldest is the least valuable. Once
// there is room, a scan of the caller finds dropped files again. This class only keeps the order:
// it runs nothing, and the caller passes the current time.
//
// Threads   One thread at a time.
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
    // The file has not changed for long: finish its volume without the end.
    bool finish_as_is = false;
    // The last close that an event reported; none if a scan or a poll found the file.
    std::optional<SteadyTime> closed_at;
    std::int64_t newest_ns = 0;  // since the epoch
    SteadyTime not_before{};
    int failures = 0;  // failed attempts to read or store the file
    // The class of the job (ready_jobs.h).
    Urgency urgency = Urgency::backlog;
    bool is_begun = false;
    std::string station;
    bool is_registered = false;  // the catalog has the file as it is or as it was before
};

enum class Offered { queued, merged, refused };

class Schedule {
  public:
    static constexpr std::chrono::seconds register_after{2};

    explicit Schedule(std::size_t limit) : limit_(limit) {}

    // Adds a job. If a job of the same file waits, merges the two: the later close and the later
    // time apply, and finish_as_is is set only if both jobs set it, because a new close means that
    // the file has changed.
    Offered offer(Job job, SteadyTime now = {});
    // Returns the first job that may run now. The job counts as running until finished() or retry()
    // is called for it.
    std::optional<Job> next(SteadyTime now);
    // Returns the job that has waited longest without being registered, if it has waited for at
    // least `register_after`. The job counts as running until registered() is called for it.
    std::optional<Job> next_unregistered(SteadyTime now);
    // Puts back a job that next_unregistered() returned, so that it can run. next_unregistered()
    // does not return it again, even if the attempt to register it failed.
    void registered(const std::filesystem::path& path);
    // Ends a job. If its file was offered again in the meantime, the new job now waits, at least
    // until `again_not_before`.
    void finished(const std::filesystem::path& path, SteadyTime again_not_before = {});
    // Puts back a job that has failed once more. It runs after retry_delay(). Returns false and
    // forgets the job if too many jobs wait for another attempt already.
    [[nodiscard]] bool retry(Job job, SteadyTime now);
    // Returns true while a worker has a job of the file, and after that until the job is passed to
    // finished() or retry().
    [[nodiscard]] bool is_running(const std::filesystem::path& path) const {
        const auto entry = entries_.find(path.native());
        return entry != entries_.end() && entry->second.has_worker;
    }
    // Notes that the worker of a job that next() returned is free again. Call it before finished()
    // or retry(). `is_good` is true if the job gridded or showed data of its station.
    void worked(const std::filesystem::path& path, SteadyTime::duration took, SteadyTime now,
                bool is_good = false);
    void set_workers(int workers) { shares_.set_workers(workers); }
    // Returns the files that lost their places to other files since the last call.
    [[nodiscard]] std::vector<std::filesystem::path> take_displaced() {
        return std::exchange(displaced_, {});
    }
    // Lets no job start before this time. Call it when the disk is full, because then every job
    // would fail.
    void hold_until(SteadyTime time) { held_until_ = time; }

    // Returns when the next waiting job may run; none if nothing waits. The time may be in the
    // past.
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // Returns when the next job must be registered; none if all are registered.
    [[nodiscard]] std::optional<SteadyTime> next_unregistered_time() const;
    // Looks at the waiting jobs that may run now, and returns when the first of these began to
    // wait; none if there is no such job.
    [[nodiscard]] std::optional<SteadyTime> oldest_offer() const;
    // Returns how long the live job waited that next() returned last.
    [[nodiscard]] SteadyTime::duration last_wait() const { return last_wait_; }
    [[nodiscard]] std::size_t waiting_count() const {
        return ready_.count() + delayed_.size() - retrying_;
    }
    [[nodiscard]] std::size_t running_count() const {
        return entries_.size() - ready_.count() - delayed_.size();
    }
    // Returns how many jobs failed and wait for their next attempt.
    [[nodiscard]] std::size_t retrying_count() const { return retrying_; }
    [[nodiscard]] std::size_t limit() const { return limit_; }
    [[nodiscard]] std::size_t retry_limit() const { return std::max<std::size_t>(4, limit_ / 4); }

    // 1 s, doubled after each failure up to 60 s
    [[nodiscard]] static std::chrono::seconds retry_delay(int failures);

  private:
    struct Entry {
        Job job;
        bool running = false;
        bool has_worker = false;   // running, returned by next()
        bool is_retrying = false;  // failed, and waits for its time
        std::optional<Job> again;  // was offered while the job ran
        std::uint64_t sequence = 0;
        SteadyTime offered_at{}, again_at{};
        std::uint64_t place = 0;  // order of offers
    };
    using DelayedKey = std::pair<SteadyTime, std::uint64_t>;

    // The value of a job within its station. The job with the smallest value is dropped first.
    using Worth = std::tuple<int, std::int64_t, std::uint64_t>;
    static Worth worth_of(const Job& job, std::uint64_t place);
    static ReadyJobs::Key key_of(const Entry& entry);
    void enqueue(Entry& entry);
    void wait_again(Entry& entry, const Job& job);
    void run(Entry& entry);
    void wait_since(Entry& entry, SteadyTime time);
    void claim(const Entry& entry);
    void unclaim(const Entry& entry);
    // Drops a waiting job that is less valuable than `job`, as described above. Returns false if
    // there is no such job.
    bool make_room_for(const Job& job);
    void drop_waiting(Entry& entry);
    static void merge(Job& into, const Job& job);

    std::size_t limit_;
    std::uint64_t next_sequence_ = 0, next_place_ = 0;
    SteadyTime held_until_{};
    std::unordered_map<std::string, Entry> entries_;
    ReadyJobs ready_;
    std::map<DelayedKey, Entry*> delayed_;
    std::map<std::uint64_t, Entry*> waiting_;       // all waiting entries, by place
    std::map<std::uint64_t, Entry*> unregistered_;  // the waiting entries that are not registered
    // The waiting jobs of each station, without the jobs that wait for another attempt.
    std::unordered_map<std::string, std::set<Worth>> claims_;
    std::size_t retrying_ = 0;
    WorkShares shares_;
    SteadyTime::duration last_wait_{};
    // No ready job may begin before this time, unless the queue changes.
    SteadyTime shares_looked_at_{};
    std::vector<std::filesystem::path> displaced_;
};

}  // namespace stormcellar::daemon

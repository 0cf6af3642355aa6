// daemon/queue/intake.h -- turns the watcher's reports into jobs that are due.
//
// The intake owns the list of files already seen (seen_files.h), the files that are not complete
// yet (growing_files.h) and the schedule, and keeps the three consistent. If one of the three is
// full, the intake forgets a file. needs_scan() then says when a scan must find that file again, so
// no file is lost.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/queue/growing_files.h"
#include "daemon/queue/pending.h"
#include "daemon/queue/schedule.h"
#include "daemon/queue/seen_files.h"
#include "daemon/queue/worker_pool.h"
#include "daemon/watch/watcher.h"

namespace stormcellar::daemon {

// The steady clock measures durations. The wall clock gives the ages of files.
struct Clock {
    std::function<SteadyTime()> steady;
    std::function<std::int64_t()> wall_ns;  // since the epoch
};
[[nodiscard]] Clock real_clock();

class Intake final : public WatchListener {
  public:
    Intake(const Config& config, Clock clock);

    // Number of attempts to ingest a file, which take about two minutes in all. Attempts that fail
    // because the system is short of disk, memory or descriptors do not count.
    static constexpr int most_tries = 8;

    // Delays files that were being ingested when the process last ended. Each of these files waits
    // for the given time from now, and then comes last in the backlog.
    void hold_back(const std::map<std::filesystem::path, std::chrono::seconds>& waits);
    // Applies a reloaded configuration: the waiting times and the number of workers.
    void reload(const ReloadableConfig& config);

    void file_closed(const std::filesystem::path& path, const FileStamp& stamp) override;
    void file_created(const std::filesystem::path& path, const FileStamp& stamp) override;
    [[nodiscard]] bool follows(const std::filesystem::path& path) const override {
        return followed_.contains(path);
    }
    void file_grew(const std::filesystem::path& path, const FileStamp& stamp) override {
        file_closed(path, stamp);
    }
    void file_found(const std::filesystem::path& path, const FileStamp& stamp) override;
    void file_gone(const std::filesystem::path& path) override;
    void directory_gone(const std::filesystem::path& path, bool deleted) override;
    void entry_left_out(const std::filesystem::path& path, std::string_view kind) override;
    void directory_unread() override { lost_ = true; }
    void entry_unseen() override;
    void events_lost() override;
    void drop_vanished() override;
    void directory_problem(const Error& error) override;

    // Call it when the catalog may have lost rows of ingested files. A scan is then due, and offers
    // all files again.
    void forget_seen();

    // Offers the growing files that are due to the schedule.
    void poll_growing();
    std::optional<Job> next_job() { return schedule_.next(clock_.steady()); }
    // Returns a job that has waited for some time, and whose file is not in the catalog yet.
    std::optional<Job> next_unregistered() { return schedule_.next_unregistered(clock_.steady()); }
    void registered(const Finished& noted);
    void job_ended(const Finished& finished);

    // Call begin_scan() before a scan of the watcher, and end_scan() after it. `whole` is true if
    // the drop directory could be read.
    void begin_scan();
    void end_scan(bool whole);
    // Returns true if a scan is needed: events were lost; directories were left to a scan; the drop
    // directory vanished; files were refused and the queue is less than half full now; or it is
    // time to look again at entries that could not be examined.
    [[nodiscard]] bool needs_scan() const;
    // Returns when to look again at entries that could not be examined. The first time is after a
    // second; the delay doubles up to a minute. Returns none if there are no such entries.
    [[nodiscard]] std::optional<SteadyTime> look_again_at() const { return look_again_at_; }

    // Returns when there is next something to do: to poll growing files, to start a job (if
    // `can_start`), or to register a file (if `can_register`).
    [[nodiscard]] std::optional<SteadyTime> next_time(bool can_start, bool can_register) const;
    [[nodiscard]] Pending pending() const;
    [[nodiscard]] std::vector<GrowingFiles::Wait> growing_waits(std::size_t most) const {
        return growing_.waits(clock_.steady(), most);
    }
    // Returns the longest wait of the jobs that may run now, or 0 if there are none.
    [[nodiscard]] SteadyTime::duration longest_wait() const;
    // Returns how long the live file waited whose job began last.
    [[nodiscard]] SteadyTime::duration last_wait() const { return schedule_.last_wait(); }
    // Returns how often the kernel dropped events since the last call.
    std::uint64_t take_overflows() { return std::exchange(overflows_, 0); }
    // Returns how often an entry could not be examined since the last call.
    std::uint64_t take_unseen() { return std::exchange(unseen_, 0); }
    // Returns problems of directories, and of entries that are not files (not_a_file). A problem
    // that every scan finds again is returned only once.
    std::vector<Error> take_directory_problems() { return std::exchange(problems_, {}); }

  private:
    void hold(Job& job);
    [[nodiscard]] Job job_for(const std::filesystem::path& path, Urgency urgency) const;
    void offer(Job job, const FileStamp& stamp);
    void tell(Error problem);
    [[nodiscard]] std::int64_t closed_now_ns();
    // Returns the station that the path names. Returns an empty text if data of that station are
    // not accepted.
    [[nodiscard]] std::string station_of(const std::filesystem::path& path) const;
    void job_failed(const Finished& finished);
    void give_next_turn(const Finished& finished);
    // Notes that the next scan must find the files that lost their places.
    void note_displaced();
    void note_represented(const std::filesystem::path& former, const std::filesystem::path& by);
    void note_going_on(const std::filesystem::path& path, bool goes_on);
    void leave_to_scan(const std::filesystem::path& path);

    [[nodiscard]] FileFound look(const std::filesystem::path& path) const {
        return look_at(path, drop_);
    }

    std::filesystem::path drop_;
    StationRule stations_;
    Clock clock_;
    std::chrono::milliseconds reread_;
    std::map<std::filesystem::path, SteadyTime> held_back_;
    Schedule schedule_;
    GrowingFiles growing_;
    SeenFiles seen_;
    // Growing files that are followed. Their jobs read only the new data, so these jobs need not
    // wait.
    std::set<std::filesystem::path> followed_;
    // Chunks whose jobs are not collected yet, each with the chunk that now represents the volume.
    std::map<std::filesystem::path, std::filesystem::path> relieved_;
    // Volumes that have closed sweeps: paths of files, and keys of volumes in chunks
    // (pipeline/drop/chunk_path.h).
    std::unordered_set<std::string> going_on_;
    bool refused_ = false;  // a file had no room since the last scan began
    bool lost_ = false;
    std::uint64_t overflows_ = 0, unseen_ = 0;
    std::optional<SteadyTime> look_again_at_;
    int looks_in_vain_ = 0;
    bool is_looking_again_ = false;  // the current scan retries entries that could not be examined
    std::vector<Error> problems_;
    SeenFiles told_;                     // problems that were reported, by their text
    std::int64_t newest_closed_ns_ = 0;  // time of the last close, since the epoch
};

}  // namespace stormcellar::daemon

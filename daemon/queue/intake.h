// daemon/queue/intake.h -- from what the watcher sees to jobs that are due.
//
// Owns the memory of seen files (seen_files.h), the files that are not complete yet
// (growing_files.h) and the schedule, and keeps the three consistent. Nothing is lost when one of
// them is full: the file is forgotten, and needs_scan() asks for a scan that finds it again. Thread
// contract: one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
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

// Two clocks: steady for durations, wall to tell which file is newest.
struct Clock {
    std::function<SteadyTime()> steady;
    std::function<std::int64_t()> wall_ns;  // since the epoch
};
[[nodiscard]] Clock real_clock();

class Intake final : public WatchListener {
  public:
    Intake(const Config& config, Clock clock);

    // How often a file that cannot be ingested is tried, over three minutes. While the system is
    // short of disk, memory or descriptors, tries do not count.
    static constexpr int most_tries = 8;

    // Sets new waiting times and another number of workers.
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

    // The results of files may have been lost: the next scan, which is due now, offers all files
    // again.
    void forget_seen();

    // Offers the growing files that are due.
    void poll_growing();
    std::optional<Job> next_job() { return schedule_.next(clock_.steady()); }
    // A file that has waited for some time without a row in the catalog.
    std::optional<Job> next_unregistered() { return schedule_.next_unregistered(clock_.steady()); }
    void registered(const Finished& noted);
    void job_ended(const Finished& finished);

    // Call these around a scan of the watcher. `whole`: the drop directory could be read.
    void begin_scan();
    void end_scan(bool whole);
    // Returns true if events were lost, the drop directory vanished, there is room again for files
    // that were refused, or it is time to look again for what could not be examined.
    [[nodiscard]] bool needs_scan() const;
    // When that time comes: a second later, and twice as long after each attempt in vain, up to a
    // minute.
    [[nodiscard]] std::optional<SteadyTime> look_again_at() const { return look_again_at_; }

    // When there is something to do: growing files to poll or, if a job can start, a job.
    [[nodiscard]] std::optional<SteadyTime> next_time(bool can_start, bool can_register) const;
    [[nodiscard]] Pending pending() const;
    [[nodiscard]] std::vector<GrowingFiles::Wait> growing_waits(std::size_t most) const {
        return growing_.waits(clock_.steady(), most);
    }
    // How long the job that has waited longest has been able to run.
    [[nodiscard]] SteadyTime::duration longest_wait() const;
    // How often the kernel dropped events since the last call.
    std::uint64_t take_overflows() { return std::exchange(overflows_, 0); }
    // How often something could not be examined since the last call.
    std::uint64_t take_unseen() { return std::exchange(unseen_, 0); }
    // Problems of directories, and of entries that are not files (not_a_file). Each is returned
    // once, as long as scans go on finding it.
    std::vector<Error> take_directory_problems() { return std::exchange(problems_, {}); }

  private:
    [[nodiscard]] Job job_for(const std::filesystem::path& path, Urgency urgency) const;
    void offer(Job job, const FileStamp& stamp);
    void tell(Error problem);
    [[nodiscard]] std::int64_t closed_now_ns();
    // The station that a path names, if its data are accepted; otherwise empty.
    [[nodiscard]] std::string station_of(const std::filesystem::path& path) const;
    void job_failed(const Finished& finished);
    void give_next_turn(const Finished& finished);
    // Files that gave their places are found again by a scan.
    void note_displaced();
    void note_going_on(const std::filesystem::path& path, bool goes_on);
    void leave_to_scan(const std::filesystem::path& path);

    [[nodiscard]] FileFound look(const std::filesystem::path& path) const {
        return look_at(path, drop_);
    }

    std::filesystem::path drop_;
    StationRule stations_;
    Clock clock_;
    std::chrono::milliseconds reread_;
    Schedule schedule_;
    GrowingFiles growing_;
    SeenFiles seen_;
    // Growing files of which only new data are read, so that they may be read at once.
    std::set<std::filesystem::path> followed_;
    // Volumes with closed sweeps: files, and the keys of volumes of chunks
    // (pipeline/drop/chunk_path.h).
    std::unordered_set<std::string> going_on_;
    bool refused_ = false;  // something had no room since the last scan began
    bool lost_ = false;
    std::uint64_t overflows_ = 0, unseen_ = 0;
    std::optional<SteadyTime> look_again_at_;
    int looks_in_vain_ = 0;
    bool is_looking_again_ = false;  // the purpose of the running scan
    std::vector<Error> problems_;
    SeenFiles told_;                     // problems that were reported, by their text
    std::int64_t newest_closed_ns_ = 0;  // as in Job
};

}  // namespace stormcellar::daemon

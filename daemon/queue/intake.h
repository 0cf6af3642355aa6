// daemon/queue/intake.h -- from what the watcher sees to jobs that are due.
//
// Owns the memory of what was seen (seen_files.h), the files that are not whole yet
// (growing_files.h) and the schedule, and keeps the three in agreement. Nothing is lost when one of
// them is full: the file is forgotten, and needs_scan() says when a scan shall find it again.
// Thread contract: one thread.
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

// What time it is, for both questions: how long (steady) and which is newest (wall).
struct Clock {
    std::function<SteadyTime()> steady;
    std::function<std::int64_t()> wall_ns;  // since the epoch
};
[[nodiscard]] Clock real_clock();

class Intake final : public WatchListener {
  public:
    Intake(const Config& config, Clock clock);

    // A file that cannot be taken in is tried so often, over three minutes, unless the system is
    // short of disk, memory or descriptors: then for as long as that lasts.
    static constexpr int most_tries = 8;

    // New times to wait and another number of workers.
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

    // What was taken in may be known no more: the next scan, which is due now, offers all again.
    void forget_seen();

    // Offers the growing files that are due.
    void poll_growing();
    std::optional<Job> next_job() { return schedule_.next(clock_.steady()); }
    // One that has waited for some time without standing in the catalog.
    std::optional<Job> next_unregistered() { return schedule_.next_unregistered(clock_.steady()); }
    void registered(const Finished& noted);
    void job_ended(const Finished& finished);

    // Around a scan of the watcher; `whole`: the drop directory could be read.
    void begin_scan();
    void end_scan(bool whole);
    // Events were lost, the drop directory vanished, there is room again for what was refused, or
    // it is time to look again for what could not be looked at.
    [[nodiscard]] bool needs_scan() const;
    // When that time comes: a second later, and twice as long each time that it was in vain, up to
    // a minute.
    [[nodiscard]] std::optional<SteadyTime> look_again_at() const { return look_again_at_; }

    // When there is something to do: growing files to poll and, if a job can start, a job.
    [[nodiscard]] std::optional<SteadyTime> next_time(bool can_start, bool can_register) const;
    [[nodiscard]] Pending pending() const;
    [[nodiscard]] std::vector<GrowingFiles::Wait> growing_waits(std::size_t most) const {
        return growing_.waits(clock_.steady(), most);
    }
    // How long the job that has waited for longest has been able to run.
    [[nodiscard]] SteadyTime::duration longest_wait() const;
    // How often the kernel dropped events, since the last call.
    std::uint64_t take_overflows() { return std::exchange(overflows_, 0); }
    // How often something could not be looked at, since the last call.
    std::uint64_t take_unseen() { return std::exchange(unseen_, 0); }
    // Of directories, and of entries that are no files (not_a_file). Each is given once, as long as
    // scans go on finding it.
    std::vector<Error> take_directory_problems() { return std::exchange(problems_, {}); }

  private:
    [[nodiscard]] Job job_for(const std::filesystem::path& path, Urgency urgency) const;
    void offer(Job job, const FileStamp& stamp);
    void tell(Error problem);
    [[nodiscard]] std::int64_t closed_now_ns();
    // The station that a path names, where data of it are taken in; else empty.
    [[nodiscard]] std::string station_of(const std::filesystem::path& path) const;
    void job_failed(const Finished& finished);
    void give_next_turn(const Finished& finished);
    // What had to give its place is found again by a scan.
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
    // Growing files of which only what is new is read, and so at once.
    std::set<std::filesystem::path> followed_;
    // Volumes of which sweeps have closed: files, and keys of chunks' volumes
    // (pipeline/drop/chunk_path.h).
    std::unordered_set<std::string> going_on_;
    bool refused_ = false;  // something did not fit since the last scan began
    bool lost_ = false;
    std::uint64_t overflows_ = 0, unseen_ = 0;
    std::optional<SteadyTime> look_again_at_;
    int looks_in_vain_ = 0;
    bool is_looking_again_ = false;  // the scan that runs is for that
    std::vector<Error> problems_;
    SeenFiles told_;                     // problems, by their text
    std::int64_t newest_closed_ns_ = 0;  // as jobs have it
};

}  // namespace stormcellar::daemon

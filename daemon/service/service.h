// daemon/service/service.h -- the main loop of the daemon.
//
// One thread does all the bookkeeping (events, schedule, logs, status); the workers only ingest
// files. The main thread polls for signals, directory events and ended jobs, and sleeps until
// something is due. It reacts as follows:
//   start            scans the drop directory and queues the files there; reports READY once state,
//                    cache and sockets answer (readiness.h). Until then it ingests what it can. It
//                    does not wait for the drop directory: if that is missing, the status reports
//                    it, and the service looks for it every second
//   SIGTERM, SIGINT  running jobs end, and the queue is dropped (the next start finds the files
//                    again)
//   SIGHUP           the configuration is read again; paths, grid and queue limit stay until a
//                    restart
// Loops run as other programs, which end with the service (daemon/loops/loop_supervisor.h), or
// another process runs them. A separate thread brings the cache within its budgets every few
// seconds.
//
// Threads   Call run() once. request_stop(), is_idle() and sites_compared() may be called from any
//           thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "daemon/care/cache_keeper.h"
#include "daemon/care/row_keeper.h"
#include "daemon/care/state_keeper.h"
#include "daemon/config/config.h"
#include "daemon/loops/loop_supervisor.h"
#include "daemon/process/main_loop.h"
#include "daemon/process/readiness.h"
#include "daemon/process/wake_up.h"
#include "daemon/queue/intake.h"
#include "daemon/queue/sink.h"
#include "daemon/queue/worker_pool.h"
#include "daemon/service/scan_times.h"
#include "daemon/service/troubles.h"
#include "daemon/status/reporter.h"
#include "daemon/status/status_board.h"
#include "daemon/status/status_file.h"
#include "daemon/watch/inotify.h"
#include "daemon/watch/watcher.h"
#include "pipeline/mosaic/site_watch.h"
#include "service/notify.h"
#include "service/pulse.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {

// The parts of the service. All must outlive the Service.
struct ServiceParts {
    Sink& sink;
    EventSource& events;
    Notifier& notifier;
    FileSystem& file_system;
    const Signals* signals = nullptr;  // null: only request_stop() ends the service
    Clock clock = real_clock();
    bool runs_loops = true;        // false: another process does (daemon/loops/loops_service.h)
    StatusBoard* board = nullptr;  // null: the status is published only in its file
    // Null: if the state directory is deleted, it is not made again.
    StateKeeper* state = nullptr;
    // Path of the status socket, which is only reported in the status.
    std::filesystem::path socket = {};
    // Returns the machines that bring partials of mosaics; empty: there are none.
    std::function<std::vector<MachineFacts>()> machines = {};
};

enum class Stopped {
    cleanly,
    with_jobs,  // jobs did not end in time; the caller must end the process without waiting for
                // them
};

class Service {
  public:
    // `config_file` is read again on SIGHUP.
    Service(const Config& config, std::filesystem::path config_file, ServiceParts parts);

    // Tells the status about a station of the catalog and its newest volume. Call before run().
    void know_station(const std::string& station, UtcTime newest_volume);
    Stopped run();
    void request_stop();
    // Returns true if no job is ready to run, so that other work may begin. May be called from any
    // thread.
    [[nodiscard]] bool is_idle() const { return idle_; }
    // Reports the differences between two sites to the log and the status. May be called from any
    // thread.
    void sites_compared(pipeline::PairReport report);
    // Adds a check that must succeed before READY. Call it before run().
    void need(Readiness::Check check) { readiness_.need(std::move(check)); }
    // Adds a thread to watch: if the thread hangs, the watchdog is no longer fed. Call it before
    // run(). The pulse must exist until run() has returned.
    void watch(std::string who, const Pulse& pulse) { pulses_.watch(std::move(who), pulse); }

  private:
    void hold_back(const std::map<std::filesystem::path, std::chrono::seconds>& waits);
    void start();
    void turn();
    void wait();
    Stopped stop();
    void handle_signals();
    void reload();
    void apply(const Config& fresh);
    void collect();
    void scan_if_due();
    void scan();
    void note_unreadable();
    void keep_workers_busy();
    [[nodiscard]] pipeline::Load load() const;
    void get_ready();
    void start_jobs();
    void keep_house();
    void look_for_troubles(SteadyTime now);
    void look_at_catalog(SteadyTime now);
    void report(const Finished& finished);
    void report_sites();
    void publish(bool at_once);
    [[nodiscard]] std::optional<Step> oldest_step() const;
    [[nodiscard]] SteadyTime next_time() const;

    const FixedConfig fixed_;
    ReloadableConfig config_;
    std::filesystem::path config_file_;
    ServiceParts parts_;
    Intake intake_;
    Watcher watcher_;
    StatusBook status_;
    StatusFile status_file_;
    Pending published_;  // the counts that were last published
    WatchdogFeed watchdog_;
    Pulses pulses_;
    WakeUp wake_up_;
    std::atomic<bool> stop_requested_ = false;
    std::atomic<bool> idle_ = false;
    Mutex compared_mutex_;
    // Reports that have not been written to the log and the status yet.
    std::vector<pipeline::PairReport> compared_ STORMCELLAR_GUARDED_BY(compared_mutex_);
    Readiness readiness_;
    DropTrouble drop_trouble_;
    StateTrouble state_trouble_;
    CatalogTrouble catalog_trouble_;
    BacklogTrouble backlog_trouble_;
    OthersLoops others_loops_;
    ScanTimes scan_times_;
    SteadyTime next_held_back_{}, next_memory_look_{};
    WorkerPool pool_;  // near the end: its threads, and the registrar's, use the members above
    WorkerPool registrar_;
    // These are the last members, because their destructors wait for their threads before the other
    // members are destroyed.
    RowKeeper row_keeper_;
    CacheKeeper cache_keeper_;
    LoopSupervisor loop_keeper_;
};

}  // namespace stormcellar::daemon

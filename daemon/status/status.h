// daemon/status/status.h -- the status of the daemon: counters, latencies, stations.
//
// The status is rendered as JSON (status_json.h) for STATE/status.json and the status server, and
// as Prometheus text (metrics_text.h).
//
// Threads   One thread at a time; StatusFacts is plain data that may be copied to other threads.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/config/loop_config.h"
#include "daemon/queue/pending.h"
#include "daemon/queue/sink.h"
#include "daemon/queue/worker_pool.h"
#include "daemon/status/machine_facts.h"
#include "daemon/status/rejected_paths.h"
#include "daemon/status/station_book.h"
#include "daemon/status/status_names.h"
#include "daemon/watch/unreadable.h"
#include "pipeline/mosaic/site_watch.h"
#include "service/timings.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::daemon {

// A volume that was gridded. Names and reasons in this and the next two structures are printable.
struct RecentVolume {
    std::string file, station, time;
    std::size_t grids = 0;
    std::optional<double> latency_s, antenna_s;
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0;
};

// A file that no longer grows, although its volume has no end.
struct WaitingFile {
    std::string file;
    double left_s = 0;  // time until its volume is finished without its end
};

struct RejectedFile {
    std::string file, station, reason;
    std::string_view code;
    UtcTime at;
};

struct StatusFacts {
    std::filesystem::path drop, cache, socket;  // socket: empty if there is none
    std::string drop_lost;  // why the drop directory cannot be read; empty: it can be read
    Unreadable unreadable;  // directories below `drop` that cannot be read
    int http_port = 0;      // 0: none
    UtcTime started = now_utc();
    std::string state = "starting";
    std::uint64_t ingested = 0, grids = 0, partial = 0, failures = 0;
    PerResult<std::uint64_t> results{};      // files
    PerErrorCode<std::uint64_t> rejected{};  // rejected files, by the fault of the file
    PerErrorCode<std::uint64_t> failed{};    // failures, by their cause
    std::uint64_t overflows = 0, scans = 0;
    std::uint64_t unseen = 0;  // entries that could not be examined
    std::size_t directories = 0;
    double longest_wait_s = 0;               // the longest wait of all waiting files
    std::vector<WaitingFile> waiting_files;  // growing files, in the order of left_s
    std::uint64_t lone_chunks = 0;  // files that look like one chunk but are not named like one
    // Files of which the cache keeps nothing, because of its budgets.
    std::uint64_t not_kept = 0;
    std::uint64_t living_left_out = 0;  // living grids that were skipped because there was no time
    std::uint64_t given_up = 0;         // growing volumes given up because there was no room; they
                                        // are read again
    std::optional<cache::StoreUsage> usage;
    CatalogState catalog;
    std::vector<LoopState> loops;
    std::vector<LoopState> others_loops;  // loops that another process runs (others_loops.h)
    Timings close_to_cache{4096};
    std::uint64_t living = 0;          // grids of volumes that had not ended; each update counts
    Timings close_to_living{4096};     // from the close of the chunk that completed a sweep
    Timings antenna_to_cache{4096};    // of data that can be live
    std::uint64_t not_live = 0;        // volumes that antenna_to_cache leaves out
    std::deque<RecentVolume> volumes;  // the last 64, oldest first
    std::deque<RejectedFile> rejected_files;  // the last 64, oldest first, each path once
    StationBook stations;
    std::map<std::array<std::string, 3>, pipeline::PairReport> sites;  // by domain, a, b
    std::vector<MachineFacts> machines;  // machines that bring partials of mosaics
};

class StatusBook {
  public:
    StatusBook(std::filesystem::path drop, std::filesystem::path cache);

    // Adds the outcome of a job. `at` is the end of the job by the wall clock. Returns false, and
    // counts nothing, if the file was already rejected for the same reason.
    bool add(const Finished& finished, UtcTime at = now_utc());
    void count_overflow() { ++facts_.overflows; }
    void count_unseen(std::uint64_t count) { facts_.unseen += count; }
    void set_longest_wait(double seconds) { facts_.longest_wait_s = seconds; }
    void set_waiting_files(std::vector<WaitingFile> files) {
        facts_.waiting_files = std::move(files);
    }
    void count_scan() { ++facts_.scans; }
    void set_directories(std::size_t watched) { facts_.directories = watched; }
    void set_drop_lost(std::string why) { facts_.drop_lost = std::move(why); }
    // Returns true if the directories have changed.
    bool set_unreadable(const Unreadable& directories);
    void set_state(std::string state) { facts_.state = std::move(state); }
    void set_listening(std::filesystem::path socket, int http_port);
    void add(pipeline::PairReport report);
    void set_loops(std::vector<LoopState> loops) { facts_.loops = std::move(loops); }
    void set_others_loops(std::vector<LoopState> loops) { facts_.others_loops = std::move(loops); }
    void set_catalog(CatalogState state) { facts_.catalog = std::move(state); }
    void set_machines(std::vector<MachineFacts> machines) { facts_.machines = std::move(machines); }
    void set_usage(const cache::StoreUsage& usage) { facts_.usage = usage; }
    // Returns the stations, so that the caller can add stations of the catalog
    // (StationBook::add_known()).
    [[nodiscard]] StationBook& stations() { return facts_.stations; }

    [[nodiscard]] const StatusFacts& facts() const { return facts_; }
    [[nodiscard]] std::string json(const Pending& pending, UtcTime now) const;
    // Returns the text for systemd's STATUS=, such as "ingested 12 (latest KTLX
    // 2022-03-17T00:08:42Z), rejected 1, waiting 3, running 2, growing 0". If the drop directory
    // cannot be read, the text begins with "waiting for the drop directory DIR: WHY; ". If only
    // directories below the drop directory cannot be read, the text begins with "cannot read N
    // directories; ".
    [[nodiscard]] std::string line(const Pending& pending) const;
    [[nodiscard]] std::uint64_t ingested() const { return facts_.ingested; }

  private:
    void add_ingested(const Finished& finished, UtcTime at);
    void add_rejected(const Finished& finished, ErrorCode code, UtcTime at);
    void add_living(const Finished& finished);

    StatusFacts facts_;
    RejectedPaths rejected_;
};

// loops_json() returns the status document of a process that only runs loops
// (daemon/loops/loops_service.h). loops_line() returns the text for its STATUS=, such as "2 of 3
// loops run, made 12".
[[nodiscard]] std::string loops_json(const std::vector<LoopState>& loops, std::string_view state,
                                     UtcTime started, UtcTime now);
[[nodiscard]] std::string loops_line(const std::vector<LoopState>& loops);

// Returns the seconds from the last close of the file to the end of the job; none if no event
// reported a close.
[[nodiscard]] std::optional<double> latency_of(const Finished& finished);

}  // namespace stormcellar::daemon

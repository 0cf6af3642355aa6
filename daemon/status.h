// daemon/status.h -- what the daemon says of itself: counters, latencies, state/status.json.
//
// status.json is one JSON document, replaced atomically, at most once a second and at the stop:
//   state          "starting" | "running" | "stopping" | "stopped"
//   pid, version, started, updated (ISO 8601 UTC)
//   drop, cache    the directories (bytes that are not UTF-8 escaped)
//   ingested       files whose volumes were gridded, each time they were
//   grids          grids committed to the cache
//   partial        how many of `ingested` were of volumes that had not ended or were damaged
//   rejected, no_moment, no_position, unchanged, vanished   files that ended so
//   failures       attempts that failed because the catalog or the cache could not be written
//   pending        {"waiting","running","growing"}: files; all zero when everything is done
//   overflows, scans, directories
//   rolling        the cache's account, null until it was first looked at:
//   {"grids","pinned","bytes",
//                  "budget_bytes" (null: no limit),"evicted","evicted_bytes","not_kept"}; the last
//                  three since the start; not_kept: grids older than what the budgets keep
//   latency_s      {"count","median","p95","max"} seconds from the close (or rename) of a file to
//                  its grids in the cache, waiting included, over the last 4096 ingested files
//                  whose close was seen; files found by a scan have none. null values with count 0
//   volumes        the last 64 ingested files, oldest first: {"file","station","time","grids",
//                  "latency_s" (null: not seen closing),"read_s","decode_s","grid_s","commit_s"}
//   sites          pairs of sites that overlap in a mosaic, by domain and names, as they were
//   compared
//                  last: {"domain","a","b","time","bias_db","azimuth_deg","elevation_deg","time_s",
//                  "cells","correlation","apart_s","faults"}; each of the four, of B against A
//                  (grid/site_comparison.h), is {"value","standard_error"} or, where it could not
//                  be told, {"untold"}; faults: those that are named, one text each
//   loops          {"running","restarts","made","last_made" (null: none yet)} of all [[loop]]
//                  tables, and "each": [{"name","running","restarts","made","last_made","frames",
//                  "last_problem" (null: none)}]
// Thread contract: one thread.
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

#include "base/file_system.h"
#include "base/utc_time.h"
#include "cache/store.h"
#include "daemon/loop_config.h"
#include "daemon/worker_pool.h"
#include "pipeline/site_watch.h"

namespace stormcellar::daemon {

struct Pending {
    std::size_t waiting = 0, running = 0, growing = 0;
};

struct LatencySummary {
    std::size_t count = 0;
    double median = 0, p95 = 0, max = 0;  // seconds; of `count` 0 meaningless
};
// By nearest rank: the smallest value that at least the share of all values do not exceed.
[[nodiscard]] LatencySummary summarise(std::vector<double> seconds);

class StatusBook {
  public:
    StatusBook(std::filesystem::path drop, std::filesystem::path cache);

    void add(const Finished& finished);
    void count_overflow() { ++overflows_; }
    void count_scan(std::size_t directories);
    void set_state(std::string state) { state_ = std::move(state); }
    void add(pipeline::PairReport report);
    void set_loops(std::vector<LoopState> loops) { loops_ = std::move(loops); }
    void set_usage(const cache::StoreUsage& usage) { usage_ = usage; }

    [[nodiscard]] std::string json(const Pending& pending, UtcTime now) const;
    // "ingested 12 (latest KTLX 2022-03-17T00:08:42Z), rejected 1, waiting 3": for STATUS=.
    [[nodiscard]] std::string line(const Pending& pending) const;
    [[nodiscard]] std::uint64_t ingested() const { return ingested_; }

  private:
    struct Volume {
        std::string file, station, time;
        std::size_t grids = 0;
        std::optional<double> latency_s;
        double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0;
    };
    void add_ingested(const Finished& finished);

    std::filesystem::path drop_, cache_;
    UtcTime started_ = now_utc();
    std::string state_ = "starting";
    std::uint64_t ingested_ = 0, grids_ = 0, partial_ = 0, failures_ = 0;
    std::array<std::uint64_t, 8> results_{};  // by IngestResult
    std::uint64_t overflows_ = 0, scans_ = 0;
    std::size_t directories_ = 0;
    std::optional<cache::StoreUsage> usage_;
    std::vector<LoopState> loops_;
    std::deque<double> latencies_;
    std::deque<Volume> volumes_;
    std::map<std::array<std::string, 3>, pipeline::PairReport> sites_;  // by domain, a, b
};

// The document and the STATUS= line of a process that keeps loops alone (daemon/loops_service.h):
// "2 of 3 loops run, made 12".
[[nodiscard]] std::string loops_json(const std::vector<LoopState>& loops, std::string_view state,
                                     UtcTime started, UtcTime now);
[[nodiscard]] std::string loops_line(const std::vector<LoopState>& loops);

// Seconds from the last close that was seen to the end of the job; none when none was seen.
[[nodiscard]] std::optional<double> latency_of(const Finished& finished);

}  // namespace stormcellar::daemon

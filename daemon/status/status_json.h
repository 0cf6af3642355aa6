// daemon/status/status_json.h -- the status as one JSON document.
//
// It is published as state/status.json (status_file.h) and as GET /status.json (status_server.h).
// Times are ISO 8601 UTC, ages and latencies seconds; what is not known is null.
//   state          "starting" | "running" | "stopping" | "stopped"
//   pid, version, started, updated
//   drop, cache    the directories (bytes that are not UTF-8 are escaped)
//   drop_lost      why the drop directory cannot be read (null: it can)
//   listening      {"socket" (null: none),"http_port" (null: none)}: the configured addresses
//   ingested       files whose volumes were gridded, counted each time
//   grids          grids committed to the cache
//   living_grids   living grids, counted each time that sweeps entered one
//   partial        how many of `ingested` were of incomplete or damaged volumes
//   rejected, no_moment, no_position, unchanged, vanished   files with this result; a rejected file
//                  counts once for a reason, however often it is read
//   rejected_by    {"corrupt": 3, ...}: rejected files by what was wrong; only what occurred
//   failures       attempts that failed because the catalog or the cache could not be written
//   failures_by    {"no_space": 2, ...}
//   lone_chunks    files that look like one chunk of a volume but do not have the name of one
//   not_kept       files of whose volumes the cache's limits keep no grid
//   pending        {"waiting","running","growing"}: files; all zero when everything is done;
//                  "waiting_files": growing files whose volume has not ended, [{"file","left_s"}]:
//                  how long until each is gridded with what it has, unless more comes; the 5
//                  soonest
//   overflows, unseen, scans, directories
//   rolling        what the cache holds, null until that is known: {"grids","pinned","bytes",
//                  "budget_bytes" (null: no limit),"evicted","evicted_bytes","not_kept"}; the last
//                  three since the start; not_kept: grids older than all that the limits keep
//   latency_s      {"count","median","p95","max"} seconds from the close (or rename) of a file to
//                  its grids in the cache, with waiting, over the last 4096 ingested files whose
//                  close was seen; files that a scan found have none. Null values if count is 0
//   sweep_latency_s   the same, from the close that completed a sweep to the living grid with it
//   antenna_to_cache_s   from the newest radial of a volume to its grids in the cache, for volumes
//                  that can have come live (at most an hour old), and "not_live": how many volumes
//                  are left out, for example replayed ones
//   volumes        the last 64 ingested files, oldest first: {"file","station","time","grids",
//                  "latency_s" (null: close not seen),"antenna_to_cache_s","read_s","decode_s",
//                  "grid_s","commit_s"}
//   rejected_files the last 64, oldest first, each path once: {"file","station","at","by","reason"}
//   stations       by name: {"station","volume_time","volume_age_s","newest_radial","ingested_at",
//                  "ingested_age_s","data_at","data_age_s","gridded","partial","rejected",
//                  "no_moment","no_position","latency_s","living_grids","sweep_latency_s",
//                  "antenna_to_cache_s" (with "last" and "last_is_live"),
//                  "missing_chunks" (how many in all),"missing" (the last 8 volumes that miss some:
//                  {"volume_time","volume_number","count","numbers"})};
//                  newest_radial is that of the newest volume; data_at: when a file was last read
//   stations_left_out    files and chunks of stations beyond the 512 that are remembered
//   sites          pairs of sites that overlap in a mosaic, by domain and names, as last compared:
//                  {"domain","a","b","time","bias_db","azimuth_deg","elevation_deg","time_s",
//                  "cells","correlation","apart_s","faults"}. Each of the four, of B against A
//                  (grid/judge/site_comparison.h), is {"value","standard_error"} or, if it could
//                  not be determined, {"untold"}; faults: one text for each fault
//   loops          {"running","restarts","made","last_made" (null: none yet)} of all [[loop]]
//                  tables, and "each": [{"name","running","restarts","made","last_made","frames",
//                  "last_problem" (null: none)}], and "elsewhere": true if another process runs
//                  them, by what it reported some seconds ago
// Thread contract: pure function.
#pragma once

#include <string>

#include "daemon/status/status.h"

namespace stormcellar::daemon {

[[nodiscard]] std::string status_json(const StatusFacts& facts, const Pending& pending,
                                      UtcTime now);

}  // namespace stormcellar::daemon

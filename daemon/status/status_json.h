// daemon/status/status_json.h -- the status as one JSON document.
//
// In state/status.json (status_file.h) and as GET /status.json (status_server.h). Times are ISO
// 8601 UTC, ages and latencies seconds; what is not known is null.
//   state          "starting" | "running" | "stopping" | "stopped"
//   pid, version, started, updated
//   drop, cache    the directories (bytes that are not UTF-8 escaped)
//   drop_lost      why the drop directory cannot be read (null: it can); it is looked at again
//   listening      {"socket" (null: none),"http_port" (null: none)}: where it was told to answer
//   ingested       files whose volumes were gridded, each time they were
//   grids          grids committed to the cache
//   living_grids   grids of volumes that had not ended, each time a sweep entered one
//   partial        how many of `ingested` were of volumes that had not ended or were damaged
//   rejected, no_moment, no_position, unchanged, vanished   files that ended so; a rejected one
//                  counts once for a reason, however often it is looked at
//   rejected_by    {"corrupt": 3, ...}: what was wrong; only what occurred
//   failures       attempts that failed because the catalog or the cache could not be written
//   failures_by    {"no_space": 2, ...}
//   lone_chunks    files that look like one chunk of a volume and are not named like one
//   not_kept       files whose volumes the cache's limits did not keep: of these nothing stands
//   pending        {"waiting","running","growing"}: files; all zero when everything is done;
//                  "waiting_files": of growing ones whose volume has no end, [{"file","left_s"}]:
//                  how long until it is taken in as it is, unless more comes; the 5 soonest
//   overflows, unseen, scans, directories
//   rolling        the cache's account, null until it was first looked at:
//   {"grids","pinned","bytes",
//                  "budget_bytes" (null: no limit),"evicted","evicted_bytes","not_kept"}; the last
//                  three since the start; not_kept: grids older than what the budgets keep
//   latency_s      {"count","median","p95","max"} seconds from the close (or rename) of a file to
//                  its grids in the cache, waiting included, over the last 4096 ingested files
//                  whose close was seen; files found by a scan have none. null values with count 0
//   sweep_latency_s   the same from the close with which a sweep was complete to the living grid
//   that
//                  shows it
//   antenna_to_cache_s   from the newest radial of a volume to its grids in the cache, of
//                  volumes that can have come live (at most an hour old), and "not_live": volumes
//                  that are left out, as of old data that are replayed
//   volumes        the last 64 ingested files, oldest first: {"file","station","time","grids",
//                  "latency_s" (null: not seen closing),"antenna_to_cache_s","read_s","decode_s",
//                  "grid_s","commit_s"}
//   rejected_files the last 64, oldest first, each path once: {"file","station","at","by","reason"}
//   stations       by name: {"station","volume_time","volume_age_s","newest_radial","ingested_at",
//                  "ingested_age_s","data_at","data_age_s","gridded","partial","rejected",
//                  "no_moment","no_position","latency_s","living_grids","sweep_latency_s",
//                  "antenna_to_cache_s" (with "last" and
//                  "last_is_live"),"missing_chunks" (how many in all),"missing" (the last 8 volumes
//                  that miss some: {"volume_time","volume_number","count","numbers"})};
//                  newest_radial is of the newest volume; data_at: a file was last looked at
//   stations_left_out    files and chunks of stations beyond the 512 that are remembered
//   sites          pairs of sites that overlap in a mosaic, by domain and names, as they were
//   compared
//                  last: {"domain","a","b","time","bias_db","azimuth_deg","elevation_deg","time_s",
//                  "cells","correlation","apart_s","faults"}; each of the four, of B against A
//                  (grid/judge/site_comparison.h), is {"value","standard_error"} or, where it could
//                  not be told, {"untold"}; faults: those that are named, one text each
//   loops          {"running","restarts","made","last_made" (null: none yet)} of all [[loop]]
//                  tables, and "each": [{"name","running","restarts","made","last_made","frames",
//                  "last_problem" (null: none)}], and
//                  "elsewhere": true where another process keeps them, by what it said of itself
//                  some seconds ago
// Thread contract: pure function.
#pragma once

#include <string>

#include "daemon/status/status.h"

namespace stormcellar::daemon {

[[nodiscard]] std::string status_json(const StatusFacts& facts, const Pending& pending,
                                      UtcTime now);

}  // namespace stormcellar::daemon

// daemon/status/status_json.h -- the status as one JSON document.
//
// The document is written to state/status.json (status_file.h) and served as GET /status.json
// (status_server.h). Times are ISO 8601 UTC; ages and latencies are in seconds; unknown values are
// null.
//   state          "starting" | "running" | "stopping" | "stopped"
//   pid, version, started, updated
//   drop, cache    the directories (bytes that are not UTF-8 are escaped)
//   drop_lost      why the drop directory cannot be read (null: it can be read)
//   unreadable directories below the drop directory that cannot be read: {"count", "directories":
//                  [{"directory", "reason"}] of the first 16}; the reason ends with a possible
//                  remedy
//   listening      {"socket" (null: none), "http_port" (null: none)}: the configured addresses
//   ingested       files whose volumes were gridded, counted each time
//   grids          grids committed to the cache
//   living_grids   grids of volumes that had not ended; each update of such a grid counts
//   partial        how many of `ingested` had volumes that had not ended or were damaged
//   rejected, no_moment, no_position, other_station, unchanged, vanished
//                  files with this result; a rejected file counts once for each reason, however
//                  often it is ingested
//   rejected_by    {"corrupt": 3, ...}: the kinds of errors that occurred
//   failures       attempts that failed because the catalog or the cache could not be written
//   failures_by    {"no_space": 2, ...}
//   lone_chunks    files that look like one chunk of a volume but are not named like one
//   not_kept       files of which the cache holds nothing, because its limits did not keep their
//                  volumes
//   pending        {"waiting", "running", "growing", "retrying"}: files; all zero when all is done;
//                  "longest_wait_s": the longest wait of files that may be ingested now;
//                  "waiting_files": [{"file", "left_s"}] of growing files whose volume has no end,
//                  with the time until each volume is finished without its end, unless more data
//                  arrive; the 5 soonest
//   overflows, unseen, scans, directories
//                  overflows of the event queue; entries that could not be examined; scans of the
//                  drop directory; directories that are watched
//   living_left_out, growing_given_up
//                  living grids that were skipped because there was no time; growing volumes that
//                  were given up because there was no room, and are read again
//   rolling        the contents of the cache, null until they were first counted: {"grids",
//                  "pinned", "bytes", "budget_bytes" (null: no limit), "evicted", "evicted_bytes",
//                  "not_kept"}; the last three count since the start; not_kept: grids that were not
//                  stored, because they were older than the grids that the budgets keep
//   catalog        {"stations": the rule ("known", "any" or "listed"), "further": stations beyond
//                  the station table that "any" has accepted, "most_further": the limit of their
//                  number, "left_alone" and "some_left_alone": the number and first names of
//                  databases of stations that the rule does not accept, "troubles": [{"station",
//                  "reason"}] of unusable databases}
//   latency_s      {"count", "median", "p95", "max"}: seconds from the close (or rename) of a file
//                  to its grids in the cache, waiting included, over the last 4096 ingested files
//                  whose close was seen; files found by a scan have no latency. The values are null
//                  if count is 0
//   sweep_latency_s  like latency_s, but from the close of the file that completed a sweep to the
//                    living grid that shows the sweep
//   antenna_to_cache_s  like latency_s, but from the newest radial of a volume to its grids in the
//                       cache, for volumes that can be live (at most an hour old); "not_live":
//                       volumes that are left out, for example old data that are replayed
//   volumes        the last 64 ingested files, oldest first: {"file", "station", "time", "grids",
//                  "latency_s" (null: close not seen), "antenna_to_cache_s", "read_s", "decode_s",
//                  "grid_s", "commit_s"}
//   rejected_files  the last 64, oldest first, each path once: {"file", "station", "at", "by",
//                   "reason"}
//   stations       by name: {"station", "volume_time", "volume_age_s", "newest_radial",
//                  "ingested_at", "ingested_age_s", "data_at", "data_age_s", "gridded", "partial",
//                  "rejected", "no_moment", "no_position", "latency_s", "living_grids",
//                  "sweep_latency_s", "antenna_to_cache_s" (also "last", "last_is_live"),
//                  "missing_chunks" (number of all), "missing" (the last 8 volumes with missing
//                  chunks: {"volume_time", "volume_number", "count", "numbers"})}; newest_radial:
//                  of the newest volume; data_at: when a file was last seen
//   stations_left_out  files and chunks of stations beyond the 512 that are remembered
//   sites          the last comparison of each pair of sites that overlap in a mosaic, by domain
//                  and names: {"domain", "a", "b", "time", "bias_db", "azimuth_deg",
//                  "elevation_deg", "time_s", "cells", "correlation", "apart_s", "faults"}; each of
//                  the four values, of B relative to A (grid/judge/site_comparison.h), is {"value",
//                  "standard_error"} or, if it could not be determined, {"untold"}; faults: one
//                  text for each
//   machines       machines that bring partials of mosaics: {"name", "directory", "late", "why"
//                  (null: not late), "newest", "newest_age_s", "arrived", "arrived_age_s", "taken",
//                  "refused", "replaced", "last_problem" (null: none)}
//   loops          {"running", "restarts", "made", "last_made" (null: none yet)} of all [[loop]]
//                  tables; "each": [{"name", "running", "restarts", "made", "last_made", "frames",
//                  "last_problem" (null: none)}]; "elsewhere": true if another process runs the
//                  loops; the values are then from its last report, some seconds ago
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string>

#include "daemon/status/status.h"

namespace stormcellar::daemon {

[[nodiscard]] std::string status_json(const StatusFacts& facts, const Pending& pending,
                                      UtcTime now);

}  // namespace stormcellar::daemon

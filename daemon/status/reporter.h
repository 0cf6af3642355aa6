// daemon/status/reporter.h -- one log line for each event, with station and volume.
//
// How many there may be of a kind: daemon/log/line_limiter.h.
// Thread contract: any thread.
#pragma once

#include "daemon/log/log.h"
#include "daemon/queue/worker_pool.h"
#include "pipeline/mosaic/site_watch.h"

namespace stormcellar::daemon {

// The line for a job that ended, names escaped, and what it is about; also what the tests read.
[[nodiscard]] std::string describe(const Finished& finished);
[[nodiscard]] About about(const Finished& finished);

// Whether what a job failed of has a line already.
enum class Named : bool { not_yet, before };

class Reporter {
  public:
    static void report(const Finished& finished, Named named = Named::not_yet);
    // A directory that cannot be watched or read.
    static void report_directory(const Error& error);
    // What two sites of a mosaic say otherwise than each other: a warning for each fault.
    static void report_sites(const pipeline::PairReport& report);
};

}  // namespace stormcellar::daemon

// daemon/status/reporter.h -- one log line for each event, with station and volume.
//
// daemon/log/line_limiter.h limits how many lines of a kind there may be. Thread contract: any
// thread.
#pragma once

#include "daemon/log/log.h"
#include "daemon/queue/worker_pool.h"
#include "pipeline/mosaic/site_watch.h"

namespace stormcellar::daemon {

// The line for a job that ended, with escaped names, and its subject; the tests read them too.
[[nodiscard]] std::string describe(const Finished& finished);
[[nodiscard]] About about(const Finished& finished);

// Whether the log has named the cause of a failed job already.
enum class Named : bool { not_yet, before };

class Reporter {
  public:
    static void report(const Finished& finished, Named named = Named::not_yet);
    // A directory that cannot be watched or read.
    static void report_directory(const Error& error);
    // How two sites of a mosaic differ: a warning for each fault.
    static void report_sites(const pipeline::PairReport& report);
};

}  // namespace stormcellar::daemon

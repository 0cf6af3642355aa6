// daemon/status/reporter.h -- writes one log line for each event, with station and volume.
//
// The number of lines of a kind is limited by daemon/log/line_limiter.h.
//
// Threads   May be called from any thread.
#pragma once

#include "daemon/log/log.h"
#include "daemon/queue/worker_pool.h"
#include "pipeline/mosaic/site_watch.h"

namespace stormcellar::daemon {

// Return the text of the log line for a job that ended, and the fields of the line. Names in the
// text are escaped.
[[nodiscard]] std::string describe(const Finished& finished);
[[nodiscard]] About about(const Finished& finished);

// Says whether an earlier log line named the failure of a job.
enum class Named : bool { not_yet, before };

class Reporter {
  public:
    static void report(const Finished& finished, Named named = Named::not_yet);
    // Reports a directory that cannot be watched or read, or an entry that is not a file.
    static void report_directory(const Error& error);
    // Reports the differences between two sites of a mosaic. Writes a warning for each fault.
    static void report_sites(const pipeline::PairReport& report);
};

}  // namespace stormcellar::daemon

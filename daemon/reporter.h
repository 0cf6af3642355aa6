// daemon/reporter.h -- one log line for each event, with station and volume.
//
// Rejected files and failures of our own are limited (20 lines in 10 s, and 3 in 10 s), and the
// number held back is logged when the period is over, so a flood cannot fill the disk with logs.
// Thread contract: one thread.
#pragma once

#include "daemon/log.h"
#include "daemon/worker_pool.h"
#include "pipeline/site_watch.h"

namespace stormcellar::daemon {

// The line for a job that ended, names escaped; also what the tests read.
[[nodiscard]] std::string describe(const Finished& finished);

class Reporter {
  public:
    void report(const Finished& finished, SteadyTime now);
    // A directory that cannot be watched or read.
    void report_directory(const Error& error, SteadyTime now);
    // What two sites of a mosaic say otherwise than each other: a warning for each fault.
    static void report_sites(const pipeline::PairReport& report);
    // Logs what was held back; call now and then.
    void report_held_back(SteadyTime now);

  private:
    RateLimit rejected_{20, std::chrono::seconds{10}};
    RateLimit failures_{3, std::chrono::seconds{10}};
    RateLimit directories_{20, std::chrono::seconds{10}};
};

}  // namespace stormcellar::daemon

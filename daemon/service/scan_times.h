// daemon/service/scan_times.h -- decides when the drop directory is scanned.
//
// After each scan comes a rest of ten times the scan's length (but at least 0.1 s), so scans take
// at most about a tenth of the time, however often they are requested. A regular scan runs every
// rescan_seconds. If some directories give the watcher no events, further scans (polls) run in
// between. Thread contract: one thread.
#pragma once

#include <algorithm>
#include <chrono>

#include "base/steady_time.h"

namespace stormcellar::daemon {

class ScanTimes {
  public:
    // Returns true if a scan is due. If `is_needed` is true, a scan is due as soon as the rest
    // after the last scan is over.
    [[nodiscard]] bool is_due(SteadyTime now, bool is_needed) const {
        return now >= next_ || (is_needed && now >= rested_);
    }
    [[nodiscard]] bool is_regular(SteadyTime now) const { return now >= next_regular_; }
    [[nodiscard]] SteadyTime next() const { return next_; }
    [[nodiscard]] SteadyTime rested() const { return rested_; }

    // Notes when a scan began and ended. The next scan is due after the time `gap`, but not before
    // the rest is over.
    void scanned(SteadyTime began, SteadyTime ended, SteadyTime::duration gap) {
        const SteadyTime::duration rest = rest_factor * (ended - began);
        rested_ = ended + std::max<SteadyTime::duration>(least_gap, rest);
        next_ = std::max(ended + gap, rested_);
    }
    void set_next_regular(SteadyTime time) { next_regular_ = time; }
    // Makes a scan due at `time`, or sooner if it was due sooner.
    void no_later_than(SteadyTime time) { next_ = std::min(next_, time); }

  private:
    static constexpr std::chrono::milliseconds least_gap{100};
    static constexpr int rest_factor = 10;

    SteadyTime rested_{}, next_{}, next_regular_{};
};

}  // namespace stormcellar::daemon

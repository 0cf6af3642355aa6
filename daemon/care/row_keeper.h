// daemon/care/row_keeper.h -- updates the rows of files that are gone.
//
// After a scan it looks at every file of the catalog, in its own thread. It marks files that are
// not there as gone; if rows take more room than they may, it deletes the oldest of these. Once an
// hour it deletes rows that have been gone for as long as the configuration says. Both duties take
// a tenth of the time at most, however often there are scans. Thread contract: one thread.
#pragma once

#include <chrono>
#include <future>

#include "base/steady_time.h"
#include "daemon/process/pulse.h"
#include "daemon/queue/sink.h"

namespace stormcellar::daemon {

class RowKeeper {
  public:
    static constexpr int rest = 10;  // it rests this many times as long as it worked
    static constexpr std::chrono::hours between_deletions{1};

    explicit RowKeeper(Sink& sink) : sink_(sink) {}

    // Begins, unless it is at work or rests. Rows of files that are gone stay for this long after
    // their last registration; 0: for ever.
    void look(SteadyTime now, std::chrono::milliseconds gone_rows_kept_for);
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of its thread

  private:
    void mark_missing();
    void roll_rows();
    void delete_gone(std::chrono::milliseconds gone_rows_kept_for);

    Sink& sink_;
    Pulse pulse_;
    SteadyTime began_{}, rested_{}, next_deletion_{};
    // How long the work took. The last member: its destructor waits before the others are
    // destroyed.
    std::future<SteadyTime::duration> work_;
};

}  // namespace stormcellar::daemon

// daemon/care/row_keeper.h -- keeps the rows of the catalog in step with the files on disk.
//
// After a scan the keeper examines every file that the catalog knows, in a thread of its own, and
// marks missing files as gone. If there are more rows than the limit allows, the keeper deletes the
// oldest rows of gone files. If the configuration limits how long rows of gone files are kept, the
// keeper deletes the rows beyond that limit once an hour. This work takes at most a tenth of the
// time, however often scans run.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <utility>

#include "base/steady_time.h"
#include "daemon/queue/sink.h"
#include "service/pulse.h"

namespace stormcellar::daemon {

class RowKeeper {
  public:
    static constexpr int rest = 10;  // the keeper rests this many times as long as it worked
    static constexpr std::chrono::hours between_deletions{1};

    // The worker thread reads `clock` to measure how long the work takes.
    explicit RowKeeper(Sink& sink, std::function<SteadyTime()> clock = steady_now)
        : sink_(sink), clock_(std::move(clock)) {}

    // Call it after each scan. Starts the work, unless the work is running or the keeper rests.
    // Keeps rows of gone files for `gone_rows_kept_for` after their last registration; 0: forever.
    void look(SteadyTime now, std::chrono::milliseconds gone_rows_kept_for);
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the thread that works

  private:
    void mark_missing();
    void roll_rows();
    void delete_gone(std::chrono::milliseconds gone_rows_kept_for);

    Sink& sink_;
    const std::function<SteadyTime()> clock_;
    Pulse pulse_;
    SteadyTime began_{}, rested_{}, next_deletion_{};
    // The work. Its result is how long it took. This member is declared last, so that its
    // destructor waits for the thread before the other members are destroyed.
    std::future<SteadyTime::duration> work_;
};

}  // namespace stormcellar::daemon

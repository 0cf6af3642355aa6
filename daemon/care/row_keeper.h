// daemon/care/row_keeper.h -- has the catalog's rows follow the files that go.
//
// After a scan, in a thread of its own, as it looks at every file of the catalog: what is not there
// is marked as gone, and where rows take more room than they may the oldest of these go. Once an
// hour rows that have been gone for long are deleted, where the configuration says so. Both take a
// tenth of the time at most, however often there are scans. Thread contract: one thread.
#pragma once

#include <chrono>
#include <future>

#include "base/steady_time.h"
#include "daemon/process/pulse.h"
#include "daemon/queue/sink.h"

namespace stormcellar::daemon {

class RowKeeper {
  public:
    static constexpr int rest = 10;  // times as long as it was at work
    static constexpr std::chrono::hours between_deletions{1};

    explicit RowKeeper(Sink& sink) : sink_(sink) {}

    // Begins, unless it is at work or rests. Rows of files that are gone stay so long after their
    // last registration; 0: for ever.
    void look(SteadyTime now, std::chrono::milliseconds gone_rows_kept_for);
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of its thread

  private:
    void mark_missing();
    void roll_rows();
    void delete_gone(std::chrono::milliseconds gone_rows_kept_for);

    Sink& sink_;
    Pulse pulse_;
    SteadyTime began_{}, rested_{}, next_deletion_{};
    // How long it took. The last member: waited for before the rest goes.
    std::future<SteadyTime::duration> work_;
};

}  // namespace stormcellar::daemon

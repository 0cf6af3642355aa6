// daemon/process/pulse.h -- whether threads move on, for the watchdog.
//
// A thread that works says so at each step; one that waits for something to do rests. What counts
// is how long the step lasts that a thread is at, so long work is no hang as long as it has steps:
//   ingest, registration   one file (worker_pool.h)
//   missing       the looking for files that went: the names of one station, or 1,000 of them
//   cache         the keeping of the budgets: one directory, or 2,048 files that go
//   caretaker     one database, one station's missing grids, one grid, one pair of sites
//   status        one turn of who answers: what has come is read, what is asked is written
//   loops         one turn of who starts and hears the loops' programs
// The thread that does the bookkeeping (service.h) is not among them: it is the one that looks.
// Thread contract: of Pulse any thread; of Pulses one.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "base/steady_time.h"

namespace stormcellar::daemon {

class Pulse {
  public:
    // At work, and a step further.
    void beat(SteadyTime now = std::chrono::steady_clock::now()) { since_ = now; }
    void rest() { since_ = resting; }
    // Since when it has been at the same step; none while it rests.
    [[nodiscard]] std::optional<SteadyTime> since() const {
        const SteadyTime since = since_;
        if (since == resting) return std::nullopt;
        return since;
    }

  private:
    static constexpr SteadyTime resting = SteadyTime::max();
    std::atomic<SteadyTime> since_{resting};
};

// At work as long as it lives.
class AtWork {
  public:
    explicit AtWork(Pulse& pulse) : pulse_(pulse) { pulse_.beat(); }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;
    ~AtWork() { pulse_.rest(); }

  private:
    Pulse& pulse_;
};

// A thread, and since when it has been at the same step.
struct Step {
    std::string who;
    SteadyTime since;
};

class Pulses {
  public:
    // The pulse must stand as long as oldest() is called.
    void watch(std::string who, const Pulse& pulse) { all_.push_back({std::move(who), &pulse}); }
    // The step that has lasted longest; none while all rest.
    [[nodiscard]] std::optional<Step> oldest() const;

  private:
    struct Watched {
        std::string who;
        const Pulse* pulse;
    };
    std::vector<Watched> all_;
};

}  // namespace stormcellar::daemon

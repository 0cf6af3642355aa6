// daemon/process/pulse.h -- whether threads make progress, for the watchdog.
//
// A thread that works reports each step; a thread that waits for work rests. What counts is how
// long the current step takes, so long work is not a hang as long as it has steps:
//   ingest, registration   one file (worker_pool.h)
//   missing       the check for files that are gone: the names of one station, or 1,000 of them
//   cache         the keeping of limits: one directory, or 2,048 evicted files
//   caretaker     one database, one station's missing grids, one grid, one pair of sites
//   status        one turn of the server: it reads what has come and writes the answers
//   loops         one turn of the thread that starts the loops' programs and reads their output
// The thread that does the bookkeeping (service.h) is not among them, because it does the checking.
// Thread contract: any thread uses a Pulse; one thread uses Pulses.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "base/steady_time.h"

namespace stormcellar::daemon {

class Pulse {
  public:
    // Reports that the thread is at work, and has begun its next step.
    void beat(SteadyTime now = std::chrono::steady_clock::now()) { since_ = now; }
    void rest() { since_ = resting; }
    // Since when the current step lasts; none while the thread rests.
    [[nodiscard]] std::optional<SteadyTime> since() const {
        const SteadyTime since = since_;
        if (since == resting) return std::nullopt;
        return since;
    }

  private:
    static constexpr SteadyTime resting = SteadyTime::max();
    std::atomic<SteadyTime> since_{resting};
};

// The thread counts as at work while the object lives.
class AtWork {
  public:
    explicit AtWork(Pulse& pulse) : pulse_(pulse) { pulse_.beat(); }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;
    ~AtWork() { pulse_.rest(); }

  private:
    Pulse& pulse_;
};

// A thread, and since when its current step lasts.
struct Step {
    std::string who;
    SteadyTime since;
};

class Pulses {
  public:
    // The pulse must live as long as oldest() is called.
    void watch(std::string who, const Pulse& pulse) { all_.push_back({std::move(who), &pulse}); }
    // The step that has lasted longest; none while all threads rest.
    [[nodiscard]] std::optional<Step> oldest() const;

  private:
    struct Watched {
        std::string who;
        const Pulse* pulse;
    };
    std::vector<Watched> all_;
};

}  // namespace stormcellar::daemon

// service/pulse.h -- shows the watchdog that threads make progress.
//
// A thread that works reports each step; a thread that waits for work is at rest. The watchdog
// checks how long the present step of each thread has lasted, so long work must be divided into
// steps:
//   ingest, registration   one file (worker_pool.h)
//   missing       the search for missing files: the names of one station, or 1,000 files
//   cache         the rolling of the cache: one directory, or 2,048 files that are removed
//   caretaker     one database, the missing grids of one station, one grid, one pair of sites
//   partials      one partial of another machine, with the frames that it changes
//   status        one turn of the status server: it reads what has arrived and answers requests
//   loops         one turn of the thread that starts and reads the programs of the loops
// The thread of the main loop (service.h) has no pulse, because this thread feeds the watchdog.
//
// Threads   Any thread may use a Pulse; one thread at a time may use a Pulses.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "base/steady_time.h"

namespace stormcellar {

class Pulse {
  public:
    // Notes that the thread is at work and begins a new step.
    void beat(SteadyTime now = std::chrono::steady_clock::now()) { since_ = now; }
    void rest() { since_ = resting; }
    // Returns the start of the present step; none while the thread is at rest.
    [[nodiscard]] std::optional<SteadyTime> since() const {
        const SteadyTime since = since_;
        if (since == resting) return std::nullopt;
        return since;
    }

  private:
    static constexpr SteadyTime resting = SteadyTime::max();
    std::atomic<SteadyTime> since_{resting};
};

// Marks the thread as working while this object lives.
class AtWork {
  public:
    explicit AtWork(Pulse& pulse) : pulse_(pulse) { pulse_.beat(); }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;
    ~AtWork() { pulse_.rest(); }

  private:
    Pulse& pulse_;
};

// A thread, and the start of its present step.
struct Step {
    std::string who;
    SteadyTime since;
};

class Pulses {
  public:
    // Adds a pulse, which must exist as long as oldest() is called.
    void watch(std::string who, const Pulse& pulse) { all_.push_back({std::move(who), &pulse}); }
    // Returns the step that has lasted longest; none if all threads are at rest.
    [[nodiscard]] std::optional<Step> oldest() const;

  private:
    struct Watched {
        std::string who;
        const Pulse* pulse;
    };
    std::vector<Watched> all_;
};

}  // namespace stormcellar

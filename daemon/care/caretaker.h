// daemon/care/caretaker.h -- checks and repairs stored data, in a thread of its own.
//
// At the start the caretaker examines every database and checks the header of every grid. Then it
// works in rounds. In each round it makes the newest missing grids, and reads and verifies every
// grid, one a second. The next round begins an hour after the last grid. The caretaker repairs
// damage (pipeline/care/mend_cache.h) and logs it. Between grids it compares overlapping sites
// (pipeline/mosaic/site_watch.h) when mosaics are complete. Arriving files have priority: the
// caretaker begins no step while jobs wait.
//
// Threads   The functions of CareLinks are called from this object's thread and must allow that.
//           The destructor waits until the step in progress (one grid or one pair of sites) has
//           ended.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "pipeline/care/mend_cache.h"
#include "pipeline/mosaic/site_watch.h"
#include "service/pulse.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {

struct CareTimes {
    // Missing grids newer than this are made again; 0: none.
    std::chrono::milliseconds refill{std::chrono::hours{6}};
    std::chrono::milliseconds between_grids{1000};
    std::chrono::milliseconds between_rounds{std::chrono::hours{1}};
    // Time between two searches for sites to compare.
    std::chrono::milliseconds between_looks{5000};
};

// The data that the caretaker looks after; all must outlive it.
struct CareOf {
    catalog::CatalogWriter& catalog;
    const cache::StoreReader& store;
    pipeline::CacheMender& mender;
    pipeline::SiteWatch& sites;
};

struct CareLinks {
    std::function<bool()> is_idle;
    std::function<void(pipeline::PairReport)> compared;
};

class Caretaker {
  public:
    Caretaker(CareOf of, CareTimes times, CareLinks links);
    Caretaker(const Caretaker&) = delete;
    Caretaker& operator=(const Caretaker&) = delete;
    ~Caretaker();

    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the object's thread

  private:
    void run();
    // Both functions return false if the thread must end.
    bool look_at_all();
    bool round();
    void examine_databases();
    // Checks every grid that can be listed. Returns false if the thread must end.
    bool check_grids(pipeline::MendDepth depth, std::chrono::milliseconds between);
    void refill();
    void refill_frames();
    void mend(const cache::StoreEntry& entry, pipeline::MendDepth depth);
    // Compares the sites that are due, at most once in `between_looks`. Returns false if the thread
    // must end.
    bool compare_sites();
    // Waits for the time `least`, and then until the service is idle. Returns false if the thread
    // must end.
    bool pause(std::chrono::milliseconds least);
    // Waits for `time` and returns false. Returns true as soon as the thread must end.
    bool is_stopped_within(std::chrono::milliseconds time) STORMCELLAR_REQUIRES(mutex_);
    // Waits for the time `least`, and then until the service is idle. Meanwhile compares the sites
    // that are due. Returns false if the thread must end.
    bool rest(std::chrono::milliseconds least);

    CareOf of_;
    CareTimes times_;
    CareLinks links_;
    std::chrono::steady_clock::time_point next_look_{};
    Mutex mutex_;
    ConditionVariable changed_;
    Pulse pulse_;
    bool stopping_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    std::thread thread_;  // the last member: it uses the members above
};

}  // namespace stormcellar::daemon

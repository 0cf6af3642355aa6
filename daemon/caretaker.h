// daemon/caretaker.h -- looks after what is stored, in a thread of its own.
//
// At the start: every database is examined, every grid's header is checked, and the newest grids
// that are missing are made again. Then, while there is nothing else to do, every grid is read and
// verified, one a second; an hour after the last one it begins again. What is damaged is mended
// (pipeline/mend_cache.h) and named in the log. Files that come go first: nothing begins here while
// jobs wait.
// Thread contract: `is_idle` is called from the thread and must be safe to call from it; the
// destructor waits for what has begun (one grid).
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "pipeline/mend_cache.h"

namespace stormcellar::daemon {

struct CareTimes {
    std::chrono::milliseconds refill{std::chrono::hours{6}};  // the newest so long; 0: none
    std::chrono::milliseconds between_grids{1000};
    std::chrono::milliseconds between_rounds{std::chrono::hours{1}};
};

class Caretaker {
  public:
    // All must outlive it.
    Caretaker(catalog::Catalog& catalog, const cache::Store& store, pipeline::CacheMender& mender,
              CareTimes times, std::function<bool()> is_idle);
    Caretaker(const Caretaker&) = delete;
    Caretaker& operator=(const Caretaker&) = delete;
    ~Caretaker();

  private:
    void run();
    void examine_databases();
    // True when all were looked at.
    bool check_grids(pipeline::MendDepth depth, std::chrono::milliseconds between);
    void refill();
    void refill_frames();
    void mend(const cache::StoreEntry& entry, pipeline::MendDepth depth);
    // Waits so long, and then until there is nothing else to do; false when it is to end.
    bool pause(std::chrono::milliseconds least);

    catalog::Catalog& catalog_;
    const cache::Store& store_;
    pipeline::CacheMender& mender_;
    CareTimes times_;
    std::function<bool()> is_idle_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stopping_ = false;  // guarded by mutex_
    std::thread thread_;     // the last member: it uses what stands above
};

}  // namespace stormcellar::daemon

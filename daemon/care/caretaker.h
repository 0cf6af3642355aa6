// daemon/care/caretaker.h -- looks after what is stored, in a thread of its own.
//
// At the start: every database is examined, every grid's header is checked, and the newest grids
// that are missing are made again. Then, while there is nothing else to do, every grid is read and
// verified, one a second; an hour after the last one it begins again. What is damaged is mended
// (pipeline/care/mend_cache.h) and named in the log. Between grids, sites that overlap are compared
// (pipeline/mosaic/site_watch.h) as frames of mosaics become complete. Files that come go first:
// nothing begins here while jobs wait. Thread contract: what CareLinks holds is called from the
// thread and must be safe to call from it; the destructor waits for what has begun (one grid, one
// pair of sites).
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "daemon/process/pulse.h"
#include "pipeline/care/mend_cache.h"
#include "pipeline/mosaic/site_watch.h"

namespace stormcellar::daemon {

struct CareTimes {
    std::chrono::milliseconds refill{std::chrono::hours{6}};  // the newest so long; 0: none
    std::chrono::milliseconds between_grids{1000};
    std::chrono::milliseconds between_rounds{std::chrono::hours{1}};
    std::chrono::milliseconds between_looks{5000};  // at the frames, for sites to compare
};

// What it works on; all must outlive it.
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

    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of its thread

  private:
    void run();
    void examine_databases();
    // True when all were looked at.
    bool check_grids(pipeline::MendDepth depth, std::chrono::milliseconds between);
    void refill();
    void refill_frames();
    void mend(const cache::StoreEntry& entry, pipeline::MendDepth depth);
    // Compares the sites that are due, if it is time to look; false when it is to end.
    bool compare_sites();
    // Waits so long, and then until there is nothing else to do; false when it is to end.
    bool pause(std::chrono::milliseconds least);
    // The same, and compares sites meanwhile.
    bool rest(std::chrono::milliseconds least);

    CareOf of_;
    CareTimes times_;
    CareLinks links_;
    std::chrono::steady_clock::time_point next_look_{};
    std::mutex mutex_;
    std::condition_variable changed_;
    Pulse pulse_;
    bool stopping_ = false;  // guarded by mutex_
    std::thread thread_;     // the last member: it uses what stands above
};

}  // namespace stormcellar::daemon

// daemon/care/caretaker.h -- verifies and mends what is stored, in its own thread.
//
// At the start it examines every database, checks the header of every grid, and makes the newest
// grids that are missing. Then, while there is nothing else to do, it reads and verifies every
// grid, one a second; an hour after the last grid it begins again. It mends what is damaged
// (pipeline/care/mend_cache.h) and logs that. Between grids it compares sites that overlap
// (pipeline/mosaic/site_watch.h) as frames of mosaics become complete. Files that come go first:
// nothing begins here while jobs wait. Thread contract: the caretaker's thread calls the functions
// in CareLinks, which must allow that. The destructor waits for what has begun (one grid, or one
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
    std::chrono::milliseconds refill{
        std::chrono::hours{6}};  // grids this much older than the newest are made again; 0: none
    std::chrono::milliseconds between_grids{1000};
    std::chrono::milliseconds between_rounds{std::chrono::hours{1}};
    std::chrono::milliseconds between_looks{5000};  // at the frames, for sites to compare
};

// What it works on; all must outlive the caretaker.
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
    // Returns false if the caretaker is to end before all grids were checked.
    bool check_grids(pipeline::MendDepth depth, std::chrono::milliseconds between);
    void refill();
    void refill_frames();
    void mend(const cache::StoreEntry& entry, pipeline::MendDepth depth);
    // Compares the sites that are due, if it is time to look. Returns false if the caretaker is to
    // end.
    bool compare_sites();
    // Waits at least this long, and then until there is nothing else to do. Returns false if the
    // caretaker is to end.
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
    std::thread thread_;     // the last member: the thread uses the members above
};

}  // namespace stormcellar::daemon

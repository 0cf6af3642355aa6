// daemon/partials/partials_keeper.h -- ingests partials of mosaics from the directories of other
// machines, in a thread of its own.
//
// As soon as a partial is complete, it is copied into the cache and the frames that it changes are
// made, the newest partial first. A damaged or truncated file is checked again when it changes, and
// at each scan. A partial that the cache has lost is copied again. While no news wait, the frames
// around partials that the cache already had are checked, and made again if they lack one.
//
// Partials are accepted from stations that are known, as for raw files ([ingest] stations), or that
// are listed for their machine or their mosaic. Stations that the configuration lists for a machine
// ([partials.stations]) are accepted only from the machines that list them. For other stations, the
// better of two different partials of a volume counts, whichever machine brought it, so that the
// frames do not depend on their order. If a partial replaces that of another machine, the log and
// the status say so.
//
// A machine is late while it has brought nothing for the allowed time, or while its newest volume
// is that much older than the newest of any machine. This is reported in the log, the status and
// the metrics; the frames decide separately for each instant (pipeline/options/partial_sources.h).
//
// Threads   facts(), scans() and pulse() from any thread. The destructor waits for what has begun
// (one
//           partial with its frames).
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/partials/machine_directory.h"
#include "daemon/process/wake_up.h"
#include "daemon/status/machine_facts.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "service/pulse.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_rule.h"

namespace stormcellar::daemon {

struct PartialsOf {
    pipeline::MosaicMaker& mosaics;
    const cache::StoreWriter& store;  // of the mosaics
    std::shared_ptr<const pipeline::PartialSources> sources;
    std::shared_ptr<StationRule> stations;  // knows stations beyond the station table
    int threads = 1;
};

struct PartialsTimes {
    std::chrono::milliseconds rescan{60'000};
    std::chrono::milliseconds poll{5'000};  // between scans of directories without events
};

class PartialsKeeper {
  public:
    // Without directories it has no thread. The objects that it refers to must outlive it.
    PartialsKeeper(PartialsConfig config, PartialsOf of, PartialsTimes times);
    PartialsKeeper(const PartialsKeeper&) = delete;
    PartialsKeeper& operator=(const PartialsKeeper&) = delete;
    ~PartialsKeeper();

    [[nodiscard]] std::vector<MachineFacts> facts() const;
    // Returns how often each directory has been scanned, counted when the turn of a scan has ended.
    [[nodiscard]] std::uint64_t scans() const { return published_scans_; }
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of its thread

  private:
    struct Machine {
        std::unique_ptr<MachineDirectory> directory;
        std::uint64_t scans = 0;
        SteadyTime next_scan{};
        SteadyTime last_news = steady_now();
        MachineFacts facts;
    };
    void run();
    void turn();
    void wait();
    void scan(Machine& machine);
    void take_lost(Machine& machine);
    bool take_one();
    bool mend_one();
    [[nodiscard]] bool is_wanted(const cache::GridName& name) const;
    [[nodiscard]] Status check_station(const Machine& machine, const cache::GridName& name,
                                       const std::string& station) const;
    void take(Machine& machine, const cache::GridName& name);
    void note_rival(Machine& machine, const cache::GridName& name, bool won);
    void refuse(Machine& machine, const cache::GridName& name, const Error& why);
    void judge();
    void publish();

    const PartialsConfig config_;
    const PartialsOf of_;
    const PartialsTimes times_;
    std::vector<Machine> machines_;  // of the thread
    bool has_more_ = false;          // of the thread: news wait
    SteadyTime next_mending_{};      // of the thread
    mutable Mutex mutex_;
    std::vector<MachineFacts> published_ STORMCELLAR_GUARDED_BY(mutex_);
    std::atomic<std::uint64_t> published_scans_{0};
    WakeUp wake_up_;
    Pulse pulse_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;  // the last member: it uses the members above
};

}  // namespace stormcellar::daemon

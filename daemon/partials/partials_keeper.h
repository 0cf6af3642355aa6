// daemon/partials/partials_keeper.h -- ingests partials of mosaics from the directories of other
// machines, in a thread of its own.
//
// The keeper copies each complete partial into the cache, the newest first, and makes the frames
// that the partial changes. It checks a damaged or truncated file again when the file changes, and
// at the next scan if the file was written less than 30 s ago. If the cache has lost a partial, the
// keeper copies the partial again. While no partials wait, the keeper looks at the frames around
// older partials, and makes a frame again if it lacks one of its partials.
//
// A partial is accepted if its station is known, as for raw files ([ingest] stations), or is listed
// for its machine or its mosaic. If [partials.stations] lists a station for some machines, only
// these machines may bring it. If machines bring different partials of a volume, the better partial
// counts, so that the frames do not depend on the order of arrival. If a partial replaces another
// machine's partial, the log and the status say so.
//
// A machine is late if it has brought nothing for `late_after`, or if its newest volume is older by
// `late_after` than the newest volume of any machine. The log, the status and the metrics report
// late machines. Frames do not depend on these reports; for each frame's instant,
// pipeline/options/partial_sources.h decides which machines are late.
//
// Threads   facts(), scans() and pulse() may be called from any thread. The destructor waits until
//           the partial in progress, and its frames, are done.
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
    // Accepts stations, also stations beyond the station table.
    std::shared_ptr<StationRule> stations;
    int threads = 1;
};

struct PartialsTimes {
    std::chrono::milliseconds rescan{60'000};
    std::chrono::milliseconds poll{5'000};  // between scans of directories that give no events
};

class PartialsKeeper {
  public:
    // Starts the thread, unless there are no directories. The objects in `of` must outlive the
    // keeper.
    PartialsKeeper(PartialsConfig config, PartialsOf of, PartialsTimes times);
    PartialsKeeper(const PartialsKeeper&) = delete;
    PartialsKeeper& operator=(const PartialsKeeper&) = delete;
    ~PartialsKeeper();

    [[nodiscard]] std::vector<MachineFacts> facts() const;
    // Returns the number of scans of the directory that was scanned least often. A scan counts once
    // the thread has ended the turn that made the scan.
    [[nodiscard]] std::uint64_t scans() const { return published_scans_; }
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the object's thread

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
    std::vector<Machine> machines_;  // used only by the thread
    bool has_more_ = false;          // used only by the thread; true: more news waits
    SteadyTime next_mending_{};      // used only by the thread
    mutable Mutex mutex_;
    std::vector<MachineFacts> published_ STORMCELLAR_GUARDED_BY(mutex_);
    std::atomic<std::uint64_t> published_scans_{0};
    WakeUp wake_up_;
    Pulse pulse_;
    std::atomic<bool> stopping_{false};
    std::thread thread_;  // the last member: it uses the members above
};

}  // namespace stormcellar::daemon

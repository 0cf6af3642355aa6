// bench/feed_run.h -- plays a national feed to stormcellard by synth/replay, and measures it.
//
// Latency    From the close of the last chunk of a volume (or its rename) to the appearance of its
//            last grid in the cache, by this program's clock.
// Sustained  The bytes sent, divided by the bytes that the national feed sends in the same wall
//            time. The time is from the first chunk until the daemon has nothing left to read. If
//            more than `most_unfinished` sent volumes have no grid, the feed pauses and later
//            catches up; after a pause of `most_drain_s` the feed ends.
// A file is deleted when its own volume and a later volume of its station have grids.
//
// Threads    One thread at a time; run() starts another thread, which watches the cache.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "bench/grid_watch.h"
#include "bench/national_feed.h"
#include "bench/process.h"
#include "stormcellar/base/result.h"
#include "synth/replay.h"

namespace stormcellar::bench {

struct StretchOptions {
    synth::Delivery delivery = synth::Delivery::growing;
    double speed = 1;
    double most_wall_s = std::numeric_limits<double>::infinity();
    double most_feed_s = 3600;
    std::size_t most_unfinished = 8;
    double most_drain_s = 100;
    level2::Moment last_moment = level2::Moment::ref;  // the last of the configuration's moments
};

struct MemorySample {
    double wall_s = 0, anonymous_mib = 0;
};

struct Stretch {
    double wall_s = 0;  // includes drain_s
    double drain_s = 0, held_s = 0;
    bool drained = false;  // if false, the daemon had more to read, and the figures are too good
    double sustained = 0;
    std::vector<double> latencies_s;
    std::size_t volumes = 0;    // volumes whose last chunk was sent
    std::size_t ungridded = 0;  // of `volumes`, those without a grid at the end
    double daemon_cpu_s = 0, player_cpu_s = 0;
    double bytes = 0;
    DaemonMemory memory;  // the largest value of each figure during the run
    std::uint64_t most_cache_bytes = 0;
    std::size_t most_waiting = 0;
    std::vector<MemorySample> samples;
    DaemonStatus last;
    std::vector<int> volumes_sent;  // by site
};

// Maps the name of a grid to the times at which a file was renamed to this name.
using Renames = std::map<std::string, std::vector<std::chrono::steady_clock::time_point>>;

class FeedRun {
  public:
    FeedRun(const NationalFeed& feed, DaemonProcess& daemon) : feed_(feed), daemon_(daemon) {}
    // Writes the chunks that every site sent before the feed's clock began, and starts the daemon.
    // When the daemon has read the chunks, calls `begin` and starts the clock.
    [[nodiscard]] Result<Stretch> run(
        const StretchOptions& options, const std::string& configuration,
        const std::function<Status()>& begin = [] { return Status{}; });
    [[nodiscard]] const Renames& renames() const { return renames_; }

  private:
    using Clock = std::chrono::steady_clock;
    struct Sent {
        Clock::time_point closed;
        double latency_s = -1;  // below 0: there is no grid
        std::size_t volume = 0;
    };
    [[nodiscard]] Status watch(level2::Moment moment);
    [[nodiscard]] Status start(const StretchOptions& options, const std::string& configuration);
    void forget_before_the_clock(std::string_view grid);
    [[nodiscard]] bool wait_until_idle(double most_s);
    void end_volume(std::size_t volume, const StretchOptions& options);
    void watch_on(const StretchOptions& options);
    void note_grids();
    void look();
    [[nodiscard]] Clock::time_point drain(double most_s);
    void finish(double bytes);

    const NationalFeed& feed_;
    DaemonProcess& daemon_;
    GridWatch watch_;
    std::vector<NationalVolume> volumes_;
    std::vector<synth::ReplayItem> items_;
    std::vector<std::filesystem::path> targets_;
    std::atomic<bool> stop_ = false, is_over_ = false;
    Clock::time_point begin_;
    Renames renames_;

    std::mutex mutex_;  // guards all members below
    std::condition_variable gridded_;
    std::unordered_map<std::string, Sent> sent_;  // by name of the grid
    std::map<std::size_t, std::size_t> last_;     // newest gridded volume of each site
    std::size_t unfinished_ = 0;
    Clock::time_point next_look_;
    Stretch stretch_;
};

// Returns the slope of a least-squares line through the samples after the first tenth, in MiB an
// hour. Returns NaN for fewer than two samples.
[[nodiscard]] double memory_slope_mib_h(std::span<const MemorySample> samples);

// A comparison of files, catalog rows and grids, which must agree after a long run.
struct SoakCheck {
    std::size_t files = 0;          // files below the drop directory
    std::size_t rows = 0;           // catalog rows of whole volumes, also of deleted files
    std::size_t missing_rows = 0;   // sent volumes without such a row
    std::size_t wrong_rows = 0;     // "gone" although the file exists, or the reverse
    std::size_t grids = 0;          // grids in the cache
    std::size_t missing_grids = 0;  // stations whose newest whole volume has no grid
    [[nodiscard]] bool agrees() const { return missing_rows + wrong_rows + missing_grids == 0; }
};
// Checks a run after its daemon has ended. Errors: those of the catalog and the cache.
[[nodiscard]] Result<SoakCheck> check_soak(const NationalFeed& feed,
                                           const std::vector<int>& volumes_sent,
                                           const DaemonProcess& daemon);

}  // namespace stormcellar::bench

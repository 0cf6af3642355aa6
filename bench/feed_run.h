// bench/feed_run.h -- plays a part of a national feed to a running daemon, and measures it.
//
// Latency    From the close of the last chunk of a volume (or its rename) to the appearance of its
//            last grid in the cache, by this program's clock.
// Sustained  The feed's time divided by the wall time, from the first chunk until the daemon has
//            nothing left to read. If more than `most_unfinished` volumes were sent and not
//            gridded, the feed pauses; if that lasts for most_drain_s, the part ends.
// Files are deleted when both they and a later volume of their station have their grids.
//
// Threads    One thread at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "bench/daemon_process.h"
#include "bench/feed_player.h"
#include "bench/grid_watch.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct StretchOptions {
    double speed = 1;
    double most_wall_s = std::numeric_limits<double>::infinity();
    double most_feed_s = std::numeric_limits<double>::infinity();
    std::size_t most_unfinished = 8;
    double most_drain_s = 100;
};

struct MemorySample {
    double wall_s = 0, anonymous_mib = 0;
};

struct Stretch {
    double feed_s = 0, wall_s = 0;  // wall_s includes the drain
    double drain_s = 0, held_s = 0;
    bool drained = false;  // if false, the daemon had more to read, and the figures are too good
    std::vector<double> latencies_s;  // ascending
    std::size_t volumes = 0;          // volumes whose last chunk was sent
    std::size_t ungridded = 0;        // those of them without a grid at the end of the drain
    double daemon_cpu_s = 0, player_cpu_s = 0;
    std::vector<std::uint64_t> bytes_of_kind;
    std::uint64_t bytes = 0, chunks = 0;
    DaemonMemory memory;  // the maximum of each
    std::uint64_t most_cache_bytes = 0;
    std::size_t most_waiting = 0;
    std::vector<MemorySample> samples;
    DaemonStatus last;

    // By nearest rank, share in (0, 1]; NaN without latencies.
    [[nodiscard]] double latency_s(double share) const;
    [[nodiscard]] double sustained() const { return feed_s / wall_s; }
};

class FeedRun {
  public:
    FeedRun(const NationalFeed& feed, DaemonProcess& daemon, Delivery delivery)
        : daemon_(daemon),
          player_(feed, daemon.drop(), delivery),
          gridded_(feed.sites().size(), -1) {}

    // Sends what every site sent before the feed's clock began. Call it before the daemon starts.
    [[nodiscard]] Status send_beginnings();
    [[nodiscard]] Status watch(const NationalFeed& feed);
    // Waits until the daemon has read what is there. Returns false if that takes longer than
    // `most_s`.
    [[nodiscard]] bool drain(double most_s);
    [[nodiscard]] Result<Stretch> run(const StretchOptions& options);
    [[nodiscard]] const FeedPlayer& player() const { return player_; }

  private:
    using Clock = std::chrono::steady_clock;
    struct Sent {
        Clock::time_point closed;
        double latency_s = -1;  // below 0: there is no grid
        std::size_t site = 0;
        int volume = 0;
    };
    void note_grids();
    void look(Stretch& stretch, Clock::time_point begin);
    [[nodiscard]] Status play(const StretchOptions& options, Stretch& stretch);

    DaemonProcess& daemon_;
    FeedPlayer player_;
    GridWatch watch_;
    double feed_s_ = 0;                           // the feed's clock
    std::unordered_map<std::string, Sent> sent_;  // in this part, by grid
    std::vector<int> gridded_;  // by site: the volume of the last grid that appeared; -1: none yet
    std::size_t unfinished_ = 0;
    Clock::time_point next_look_;
};

}  // namespace stormcellar::bench

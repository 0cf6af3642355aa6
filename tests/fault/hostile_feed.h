// tests/fault/hostile_feed.h -- real stations that send volumes during an attack, and the latency
// of their grids.
//
// Sixteen stations of the table send simulated volumes at the same time, each station one volume
// after another. A volume has five sweeps, the lowest with 720 radials, the other sweeps with 360.
// Files are written as LDM does: a record is appended and the file closed, again and again; every
// fourth station sends one file for each chunk. The latency of a volume is the time from the close
// of its last piece to the moment at which a reader of the cache finds the grid of the whole
// volume.
//
// Threads   begin() and finish() from one thread; two threads work between them.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"
#include "synth/replay_writer.h"

namespace stormcellar::fault {

[[nodiscard]] std::span<const std::string_view> real_stations();

struct RealVolume {
    std::string station;
    UtcTime time;
    std::vector<std::filesystem::path> files;  // all files of a volume in chunks
    std::chrono::steady_clock::time_point closed;
    std::optional<double> latency_s;  // none: no whole grid was seen
};

class RealFeed {
  public:
    // `period_s`: time between the starts of two volumes of a station.
    RealFeed(std::filesystem::path drop, std::filesystem::path cache, double period_s);
    RealFeed(const RealFeed&) = delete;
    RealFeed& operator=(const RealFeed&) = delete;
    ~RealFeed();

    void begin();
    // Begins no further volumes, finishes the volumes that have begun, and waits at most
    // `most_wait_s` for their grids. Returns all volumes that were written.
    std::vector<RealVolume> finish(double most_wait_s);
    [[nodiscard]] std::size_t begun() const { return begun_; }

  private:
    using Clock = std::chrono::steady_clock;
    struct Station {
        level2::Volume pattern;
        bool comes_as_chunks = false;
        int number = 0;  // number of its volume
        Clock::time_point next_piece;
        RealVolume volume;
        std::vector<std::vector<std::byte>> pieces;
        std::size_t next = 0;
    };
    void write();
    void begin_volume(Station& station);
    void write_piece(Station& station);
    void watch();
    void look_at_waiting(std::vector<std::int64_t>& seen_ns);

    std::filesystem::path drop_, cache_;
    double period_s_;
    std::vector<Station> stations_;
    synth::PieceWriter writer_{0};
    std::atomic<std::size_t> begun_ = 0;
    std::atomic<bool> ending_ = false, is_watched_ = false;
    std::mutex mutex_;  // guards closed_
    std::vector<RealVolume> closed_;
    std::thread writing_, watching_;
};

}  // namespace stormcellar::fault

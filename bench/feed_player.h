// bench/feed_player.h -- writes a national feed into a drop directory, chunk by chunk, as LDM does.
//
// The feed has its own clock in seconds: chunk j of n comes at start + (j + 1) / n * period. Files
// are copied inside the kernel, so that the player takes little time from the daemon.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "bench/national_feed.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

enum class Delivery : std::uint8_t {
    growing,  // appended and closed for each chunk: FILE -close
    open,     // appended and kept open until the last chunk of the volume: FILE
    whole,    // a dot-file that grows and is renamed at the last chunk
    chunks    // one file for each chunk, DROP/KTLX/NUMBER/DATE-TIME-NNN-S|I|E
};

// A volume whose last chunk was written.
struct SentVolume {
    std::size_t site = 0;
    int volume = 0;
    std::string grid;  // the name of its grid's file
    std::chrono::steady_clock::time_point closed;
};

class FeedPlayer {
  public:
    FeedPlayer(const NationalFeed& feed, std::filesystem::path drop, Delivery delivery);
    FeedPlayer(const FeedPlayer&) = delete;
    FeedPlayer& operator=(const FeedPlayer&) = delete;
    ~FeedPlayer();

    // Returns the feed's time of the next chunk.
    [[nodiscard]] double next_s() const { return due_.top().first; }
    // Writes the next chunk. Calls `sent` with its volume if it was the last one.
    [[nodiscard]] Status write_next(const std::function<void(SentVolume)>& sent);

    // Deletes the file of a volume, as LDM's scour deletes old files.
    void scour(std::size_t site, int volume) const;

    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    [[nodiscard]] std::uint64_t bytes_of_kind(int kind) const;
    [[nodiscard]] std::uint64_t chunks() const { return chunks_; }
    [[nodiscard]] const std::vector<int>& volumes_sent() const { return volumes_sent_; }  // by site

  private:
    struct Place {
        int volume = 0;
        std::size_t chunk = 0;
        int source = -1, target = -1;  // descriptors
    };
    [[nodiscard]] std::filesystem::path path_of(std::size_t site, int volume, bool finished) const;
    [[nodiscard]] std::filesystem::path chunk_path(std::size_t site, const Place& place) const;
    [[nodiscard]] Status begin_volume(std::size_t site, Place& place);
    [[nodiscard]] Status copy(std::size_t site, Place& place, std::uint64_t from, std::uint64_t to);
    [[nodiscard]] Status end_volume(std::size_t site, Place& place);

    const NationalFeed& feed_;
    std::filesystem::path drop_;
    Delivery delivery_;
    std::vector<Place> places_;  // by site
    using Due = std::pair<double, std::size_t>;
    std::priority_queue<Due, std::vector<Due>, std::greater<>> due_;  // time, site
    std::uint64_t bytes_ = 0, chunks_ = 0;
    std::vector<std::uint64_t> bytes_of_kind_;
    std::vector<int> volumes_sent_;
};

}  // namespace stormcellar::bench

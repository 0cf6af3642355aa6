// fetch/feed/station_follower.h -- decides what to list next for a station, and finds the new
// chunks in the answer.
//
// The follower follows one volume. It lists the keys from the first missing chunk on, so that it
// sees late chunks as well as new chunks. When the volume is complete, and at every fourth listing
// without news, it lists the directory of the next number instead. There it asks only for keys from
// at most an hour before this volume, because older keys belong to an earlier round of the ring of
// volume numbers (1 follows 999). It also follows a later volume in the same directory. If it left
// the last volume with gaps or without its end, it lists that volume again every 15 s for a minute.
// If a station is silent, it lists the next directory more often. It then also lists directories
// where the station may have continued: two numbers further, number 1, and in steps around the
// whole ring.
//
// The caller asks the bucket, writes the chunks, and passes the time.
//
// Threads   Plain data; one thread at a time.
#pragma once

#include <bitset>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/steady_time.h"
#include "fetch/bucket/bucket_listing.h"
#include "fetch/feed/chunk_key.h"
#include "fetch/feed/newest_search.h"

namespace stormcellar::feed {

// The written or given-up chunks of a volume.
class VolumeChunks {
  public:
    [[nodiscard]] bool has(int number) const {
        return done_.test(static_cast<std::size_t>(number));
    }
    void add(int number, level2::ChunkKind kind);
    // Returns the largest number up to which no chunk is missing; 0 if the first chunk is missing.
    [[nodiscard]] int without_gap() const;
    [[nodiscard]] bool is_whole() const { return end_ > 0 && without_gap() >= end_; }
    [[nodiscard]] int highest() const { return highest_; }
    // Returns how many chunks are missing below highest(), plus 1 if the last chunk has not come.
    [[nodiscard]] int missing() const;

  private:
    std::bitset<last_chunk + 1> done_;
    int highest_ = 0, end_ = 0;
};

class StationFollower {
  public:
    // `written` lists the volumes with which to continue, oldest first, at most two. If the list is
    // empty, the follower searches for the newest volume.
    StationFollower(std::string station, const std::vector<VolumeId>& written, SteadyTime now);

    [[nodiscard]] fetch::ListingQuestion question(SteadyTime now, bool is_silent);

    struct Chunk {
        ChunkKey key;
        std::uint64_t size_bytes = 0;
        std::optional<UtcTime> modified;
    };
    struct News {
        std::vector<Chunk> chunks;  // in the order of their numbers
        bool is_urgent = false;     // the caller may ask the next question at once
    };
    // Takes the answer to the last question, and returns the new chunks in it.
    [[nodiscard]] News take(const fetch::ListingPage& answer, UtcTime utc, SteadyTime now);
    // Notes that a chunk was written or given up.
    void note_done(const ChunkKey& key);

    [[nodiscard]] bool is_searching() const { return search_.has_value(); }
    [[nodiscard]] std::optional<VolumeId> volume() const;
    [[nodiscard]] int chunk() const { return current_ ? current_->chunks.highest() : 0; }
    [[nodiscard]] std::uint64_t missing() const { return missing_; }

  private:
    enum class Asked { search, current, previous, directory };
    struct Followed {
        VolumeId id;
        VolumeChunks chunks;
        SteadyTime next_look{}, until{};  // for a volume that was left
    };
    [[nodiscard]] fetch::ListingQuestion question_of(const Followed& volume) const;
    [[nodiscard]] fetch::ListingQuestion question_of_directory(bool is_silent);
    [[nodiscard]] int next_directory(bool is_silent);
    [[nodiscard]] News new_in(const fetch::ListingPage& answer, UtcTime utc, SteadyTime now);
    [[nodiscard]] News take_search(const fetch::ListingPage& answer, UtcTime utc);
    [[nodiscard]] std::vector<Chunk> chunks_in(const fetch::ListingPage& answer, UtcTime utc) const;
    void begin(const VolumeId& id, SteadyTime now);
    void leave_previous();

    std::string station_;
    std::optional<NewestSearch> search_;
    VolumeId last_;  // the volume before the next expected volume
    std::optional<Followed> current_, previous_;
    Asked asked_ = Asked::search;
    fetch::ListingQuestion question_;
    int in_vain_ = 0;  // consecutive answers without new chunks
    int probes_ = 0;   // directories listed while the station was silent
    std::uint64_t missing_ = 0;
};

}  // namespace stormcellar::feed

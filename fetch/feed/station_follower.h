// fetch/feed/station_follower.h -- decides what to list next for a station, and what is new in an
// answer.
//
// It follows one volume. It lists the keys after the last chunk without a gap before it, so it sees
// a late chunk as well as the next one. When the volume is complete, and at each fourth listing in
// vain, it lists the directory of the next number instead, from an hour before this volume on,
// because older keys belong to an earlier round of the ring. It also follows a later volume in the
// same directory. If it left a volume with gaps or without its end, it looks at it again every 15 s
// for a minute. If a station is silent, it also looks where the station may have continued: one
// number further, at number 1, and in steps around the whole ring.
//
// The caller asks the bucket, writes the chunks and passes the time.
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

// The chunks of a volume that were written or given up.
class VolumeChunks {
  public:
    [[nodiscard]] bool has(int number) const {
        return done_.test(static_cast<std::size_t>(number));
    }
    void add(int number, level2::ChunkKind kind);
    // Returns the last chunk before which none is missing; 0 if the first is missing.
    [[nodiscard]] int without_gap() const;
    [[nodiscard]] bool is_whole() const { return end_ > 0 && without_gap() >= end_; }
    [[nodiscard]] int highest() const { return highest_; }
    // Returns how many chunks are missing below the highest that came, counting the end if it did
    // not come.
    [[nodiscard]] int missing() const;

  private:
    std::bitset<last_chunk + 1> done_;
    int highest_ = 0, end_ = 0;
};

class StationFollower {
  public:
    // `written` are the volumes to continue with, oldest first, at most two; if there are none, the
    // newest volume is searched.
    StationFollower(std::string station, const std::vector<VolumeId>& written, SteadyTime now);

    [[nodiscard]] fetch::ListingQuestion question(SteadyTime now, bool is_silent);

    struct Chunk {
        ChunkKey key;
        std::uint64_t size_bytes = 0;
        std::optional<UtcTime> modified;
    };
    struct News {
        std::vector<Chunk> chunks;  // in the order of their numbers
        bool is_urgent = false;     // ask the next question at once
    };
    // Takes the answer to the last question.
    [[nodiscard]] News take(const fetch::ListingPage& answer, UtcTime utc, SteadyTime now);
    // Notes that the chunk was written or given up.
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
    VolumeId last_;  // the volume before the expected one
    std::optional<Followed> current_, previous_;
    Asked asked_ = Asked::search;
    fetch::ListingQuestion question_;
    int in_vain_ = 0;  // consecutive answers without anything new
    int probes_ = 0;   // for a silent station
    std::uint64_t missing_ = 0;
};

}  // namespace stormcellar::feed

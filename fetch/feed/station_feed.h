// fetch/feed/station_feed.h -- copies the chunks of one station from the bucket into the drop
// directory.
//
// A turn is one listing, followed by requests for the new chunks in it, in the order of their
// numbers. The station makes one request at a time. A chunk that is in the drop directory with the
// right size is not fetched, for example after a restart. If a chunk is smaller or larger than
// listed, or the bucket refuses it, the station tries three times and then gives the chunk up. If
// requests fail for another reason, the station tries eight times. A chunk that is listed with no
// bytes, or with more than 4 MiB, is given up at once. After a failure the station pauses, and then
// lists again.
//
// Threads   All calls must come from the thread of BucketClient::run().
// Errors    None. status() and the log report failures.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "base/rate_limit.h"
#include "fetch/feed/bucket_client.h"
#include "fetch/feed/feed_drop.h"
#include "fetch/feed/feed_status.h"
#include "fetch/feed/poll_pace.h"
#include "fetch/feed/station_follower.h"

namespace stormcellar::feed {

// The objects that all stations share. They must outlive the stations.
struct FeedTools {
    BucketClient& client;
    FeedDrop& drop;
    RateLimit& lines;  // limits log lines
    const FeedConfig& config;
};

class StationFeed {
  public:
    // `written` lists the volumes with which to continue (see StationFollower).
    StationFeed(std::string station, const std::vector<VolumeId>& written, FeedTools tools,
                unsigned seed);
    StationFeed(const StationFeed&) = delete;
    StationFeed& operator=(const StationFeed&) = delete;
    ~StationFeed() = default;

    // Asks for the first listing after `wait`. Each answer leads to the next request.
    void begin(std::chrono::milliseconds wait) { ask(wait); }
    [[nodiscard]] StationStatus status() const;

  private:
    void ask(std::chrono::milliseconds wait);
    void take(Result<fetch::ListingPage> answer);
    void get_next();
    void keep(Result<Bytes> bytes);
    void finish_chunk();
    void finish_turn();
    void give_up(const Error& why);
    void fail_turn(const Error& why);
    void note_good();
    void note_silence();
    void complain(const Error& why);

    const std::string station_;
    FeedTools tools_;
    PollPace pace_;
    StationFollower follower_;
    std::deque<StationFollower::Chunk> wanted_;
    bool has_news_ = false;  // this turn has had a new chunk
    int tries_ = 0;          // how often tried_ has failed, over all turns
    ChunkKey tried_;
    std::optional<UtcTime> modified_;  // when the last chunk came into the bucket
    std::chrono::milliseconds between_chunks_{0};
    SteadyTime failing_since_{};
    // The time of the last chunk, plus the time that failures have lasted since then.
    SteadyTime quiet_since_ = steady_now();
    StationStatus status_;
};

}  // namespace stormcellar::feed

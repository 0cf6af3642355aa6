// fetch/feed/station_feed.h -- brings the chunks of one station from the bucket into the drop
// directory.
//
// It asks one thing at a time: a listing, then the chunks that the listing names anew, in the order
// of their numbers. A chunk that is in the drop directory with its size is not fetched again, so
// nothing is lost or repeated over a restart. A chunk that comes with another size than listed, or
// that the bucket does not give although it lists it, is given up after three tries, any other one
// after eight. After a failure the station pauses, and then lists again.
//
// Threads   One thread at a time, that of BucketClient::run().
// Errors    None; status() and the log tell of failures.
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

// All stations share these. They must outlive the stations.
struct FeedTools {
    BucketClient& client;
    FeedDrop& drop;
    RateLimit& lines;  // of the log
    const FeedConfig& config;
};

class StationFeed {
  public:
    // `written`: the volumes to go on with, as for StationFollower.
    StationFeed(std::string station, const std::vector<VolumeId>& written, FeedTools tools,
                unsigned seed);
    StationFeed(const StationFeed&) = delete;
    StationFeed& operator=(const StationFeed&) = delete;
    ~StationFeed() = default;

    // Asks for the first listing after this time. Everything else follows from the answers.
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
    bool has_news_ = false;  // in this turn
    int tries_ = 0;          // of wanted_.front(), over all turns
    ChunkKey tried_;
    std::optional<UtcTime> modified_;  // of the last chunk
    std::chrono::milliseconds between_chunks_{0};
    SteadyTime failing_since_{};
    // The last chunk came then, or later by the time in which turns failed.
    SteadyTime quiet_since_ = steady_now();
    StationStatus status_;
};

}  // namespace stormcellar::feed

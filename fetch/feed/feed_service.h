// fetch/feed/feed_service.h -- follows the configured stations on one thread, fills the drop
// directory and writes the status file.
//
// If the last volumes of a station in the drop directory began less than 20 minutes ago, the
// station continues with them. Otherwise it begins with the volume before the newest.
//
// Threads   One thread at a time.
// Errors    open(): the directories cannot be made or read, or libcurl cannot be started.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fetch/feed/feed_config.h"
#include "fetch/feed/station_feed.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::feed {

class FeedService {
  public:
    static Result<std::unique_ptr<FeedService>> open(FileSystem& file_system,
                                                     const FeedConfig& config);
    FeedService(const FeedService&) = delete;
    FeedService& operator=(const FeedService&) = delete;
    ~FeedService() = default;

    // Follows the stations until the flag is set. Calls `turn` at least ten times a second.
    void run(const std::atomic<bool>& stop, const std::function<void()>& turn);
    // Writes status.json if its contents have changed. Errors: errors of writing.
    Status publish();
    [[nodiscard]] FeedStatus status() const;

  private:
    FeedService(FileSystem& file_system, const FeedConfig& config, FeedDrop drop,
                std::unique_ptr<BucketClient> client);
    void prune();

    FileSystem& file_system_;
    const FeedConfig config_;
    FeedDrop drop_;
    std::unique_ptr<BucketClient> client_;
    RateLimit lines_{20, std::chrono::seconds{60}};
    std::vector<std::unique_ptr<StationFeed>> stations_;
    std::uint64_t removed_ = 0;
    SteadyTime next_prune_{};
    std::string published_;  // the last status, without the time at which it was written
};

}  // namespace stormcellar::feed

// tests/fetch/feed/running_feed.h -- a FeedService that runs beside the test, has its own drop
// directory, and asks 20 times a second.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "fetch/feed/feed_service.h"
#include "tests/fetch/feed/chunk_bucket.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::feed {

class RunningFeed {
  public:
    explicit RunningFeed(const ChunkBucket& bucket, std::vector<std::string> stations = {"KTLX"}) {
        config.bucket = bucket.url();
        config.stations = std::move(stations);
        config.drop = directory_ / "drop";
        config.state = directory_ / "state";
        config.every = std::chrono::milliseconds{50};
        config.stall = std::chrono::seconds{1};
        config.most_in_vain = 100'000;
    }
    RunningFeed(const RunningFeed&) = delete;
    RunningFeed& operator=(const RunningFeed&) = delete;
    ~RunningFeed() { stop(); }

    void start(FileSystem& file_system = real_file_system()) {
        auto opened = FeedService::open(file_system, config);
        if (!opened) throw std::runtime_error(opened.error().message);
        service_ = std::move(*opened);
        stop_ = false;
        thread_ = std::thread([this] {
            service_->run(stop_, [this] {
                const std::scoped_lock lock(mutex_);
                status_ = service_->status();
            });
        });
    }
    void stop() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        service_.reset();
    }
    [[nodiscard]] StationStatus station(std::size_t number = 0) const {
        const std::scoped_lock lock(mutex_);
        return number < status_.stations.size() ? status_.stations[number] : StationStatus{};
    }
    // Returns the files that stormcellard would see.
    [[nodiscard]] std::map<std::string, std::string> files() const {
        auto files = files_below(config.drop);
        std::erase_if(files,
                      [](const auto& one) { return one.first.find("/.") != std::string::npos; });
        return files;
    }
    bool wait_for_files(std::size_t count) const {
        return testing::eventually([&] { return files().size() >= count; });
    }
    FeedService& service() { return *service_; }

    FeedConfig config;  // change it before start()

  private:
    testing::TemporaryDirectory directory_;
    std::unique_ptr<FeedService> service_;
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;  // guards status_
    FeedStatus status_;
    std::thread thread_;
};

}  // namespace stormcellar::feed

#include "fetch/feed/feed_service.h"

#include <random>
#include <span>
#include <system_error>
#include <utility>

#include "base/counted.h"
#include "service/log.h"

namespace stormcellar::feed {
namespace {

constexpr std::chrono::minutes gone_on_with{20};
constexpr std::size_t volumes_gone_on_with = 2;

}  // namespace

Result<std::unique_ptr<FeedService>> FeedService::open(FileSystem& file_system,
                                                       const FeedConfig& config) {
    std::error_code error;
    std::filesystem::create_directories(config.state, error);
    if (error) return fail(ErrorCode::io, "{}: {}", config.state.native(), error.message());
    if (Status swept = remove_temporaries(file_system, config.state); !swept) return pass_on(swept);
    auto drop = FeedDrop::open(file_system, config.drop, {config.keep, config.bytes}, now_utc());
    if (!drop) return pass_on(drop);
    auto client = BucketClient::open(config);
    if (!client) return pass_on(client);
    return std::unique_ptr<FeedService>(
        new FeedService(file_system, config, std::move(*drop), std::move(*client)));
}

FeedService::FeedService(FileSystem& file_system, const FeedConfig& config, FeedDrop drop,
                         std::unique_ptr<BucketClient> client)
    : file_system_(file_system),
      config_(config),
      drop_(std::move(drop)),
      client_(std::move(client)) {
    std::random_device chance;
    const UtcTime now = now_utc();
    for (const std::string& station : config_.stations) {
        auto written = drop_.newest_of(station, volumes_gone_on_with);
        std::erase_if(written,
                      [&](const VolumeId& volume) { return volume.time < now - gone_on_with; });
        stations_.push_back(std::make_unique<StationFeed>(
            station, written, FeedTools{*client_, drop_, lines_, config_}, chance()));
    }
    // Let stations start at random times, so that they do not all ask at once.
    std::uniform_int_distribution<std::chrono::milliseconds::rep> some(0, config_.every.count());
    for (const auto& station : stations_)
        station->begin(std::chrono::milliseconds{some(chance)});
}

void FeedService::run(const std::atomic<bool>& stop, const std::function<void()>& turn) {
    client_->run(stop, [&] {
        if (drop_.is_full()) removed_ += drop_.prune(now_utc());
        if (steady_now() >= next_prune_) prune();
        turn();
    });
}

void FeedService::prune() {
    next_prune_ = steady_now() + config_.between_prunes;
    removed_ += drop_.prune(now_utc());
    if (const auto lines = lines_.take_held_back(steady_now()))
        say(LogLevel::warning, "{} about stations were not logged", counted(*lines, "line"));
}

FeedStatus FeedService::status() const {
    FeedStatus status{.bucket = config_.bucket,
                      .drop = config_.drop.native(),
                      .bytes = drop_.bytes(),
                      .volumes = drop_.volumes(),
                      .removed = removed_,
                      .stations = {}};
    for (const auto& station : stations_)
        status.stations.push_back(station->status());
    return status;
}

Status FeedService::publish() {
    const FeedStatus now = status();
    std::string text = status_text(now, UtcTime{});
    if (text == published_) return {};
    const std::string dated = status_text(now, now_utc());
    const Status written = write_file_atomically(file_system_, config_.state / "status.json",
                                                 std::as_bytes(std::span(dated)));
    if (written) published_ = std::move(text);
    return written;
}

}  // namespace stormcellar::feed

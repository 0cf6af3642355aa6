#include "bench/feed_player.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "bench/stamped_records.h"
#include "level2/containers/archive_header.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> system_failure(const fs::path& path) {
    return fail(errno == ENOSPC ? ErrorCode::no_space : ErrorCode::io, "{}: {}", path.native(),
                std::system_category().message(errno));
}

// the 24 bytes at the start of a volume
using Header = std::array<std::byte, level2::archive_header_bytes>;

Status put_header(int source, int target, const fs::path& path, UtcTime start) {
    Header header{};
    if (::pread(source, header.data(), header.size(), 0) != static_cast<ssize_t>(header.size())) {
        return system_failure(path);
    }
    stamp_header_time(header, start);
    if (::pwrite(target, header.data(), header.size(), 0) != static_cast<ssize_t>(header.size())) {
        return system_failure(path);
    }
    return {};
}

Status copy_range(int source, std::uint64_t from, std::uint64_t to, int target,
                  std::uint64_t target_at, const fs::path& path) {
    auto source_at = static_cast<off_t>(from);
    auto at = static_cast<off_t>(target_at);
    while (source_at < static_cast<off_t>(to)) {
        const ssize_t copied = ::copy_file_range(source, &source_at, target, &at,
                                                 to - static_cast<std::uint64_t>(source_at), 0);
        if (copied <= 0) return system_failure(path);
    }
    return {};
}

}  // namespace

FeedPlayer::FeedPlayer(const NationalFeed& feed, fs::path drop, Delivery delivery)
    : feed_(feed),
      drop_(std::move(drop)),
      delivery_(delivery),
      places_(feed.sites().size()),
      bytes_of_kind_(16),
      volumes_sent_(feed.sites().size()) {
    for (std::size_t site = 0; site < places_.size(); ++site) {
        const double step_s =
            feed.period_s() / static_cast<double>(feed.file_of(feed.sites()[site], 0).ends.size());
        due_.emplace(feed.sites()[site].first_start_s + step_s, site);
        std::error_code ignored;
        fs::create_directories(drop_ / feed.sites()[site].station.icao, ignored);
    }
}

FeedPlayer::~FeedPlayer() {
    for (const Place& place : places_) {
        if (place.source >= 0) ::close(place.source);
        if (place.target >= 0) ::close(place.target);
    }
}

std::uint64_t FeedPlayer::bytes_of_kind(int kind) const {
    return bytes_of_kind_[static_cast<std::size_t>(kind)];
}

fs::path FeedPlayer::path_of(std::size_t site, int volume, bool finished) const {
    const NationalSite& sender = feed_.sites()[site];
    const fs::path directory = drop_ / sender.station.icao;
    if (delivery_ == Delivery::chunks) return directory / std::to_string(volume % 1000);
    const bool hidden = delivery_ == Delivery::whole && !finished;
    return directory / fmt::format("{}{}{}_V06", hidden ? "." : "", sender.station.icao,
                                   format_compact(feed_.start_of(sender, volume)));
}

fs::path FeedPlayer::chunk_path(std::size_t site, const Place& place) const {
    if (delivery_ != Delivery::chunks) return path_of(site, place.volume, false);
    const NationalSite& sender = feed_.sites()[site];
    level2::ChunkName name;
    name.volume = format_compact(feed_.start_of(sender, place.volume));
    name.volume[8] = '-';
    name.number = static_cast<int>(place.chunk) + 1;
    const bool last = place.chunk + 1 == feed_.file_of(sender, place.volume).ends.size();
    if (last) name.kind = level2::ChunkKind::end;
    if (place.chunk == 0) name.kind = level2::ChunkKind::start;
    return path_of(site, place.volume, false) / to_string(name);
}

Status FeedPlayer::begin_volume(std::size_t site, Place& place) {
    const NationalFile& file = feed_.file_of(feed_.sites()[site], place.volume);
    place.source = ::open(file.path.c_str(), O_RDONLY | O_CLOEXEC);
    if (place.source < 0) return system_failure(file.path);
    if (delivery_ == Delivery::chunks) {
        std::error_code ignored;
        fs::create_directories(path_of(site, place.volume, false), ignored);
    }
    return {};
}

void FeedPlayer::scour(std::size_t site, int volume) const {
    std::error_code ignored;
    fs::remove_all(path_of(site, volume, true), ignored);
}

Status FeedPlayer::copy(std::size_t site, Place& place, std::uint64_t from, std::uint64_t to) {
    const fs::path path = chunk_path(site, place);
    if (place.target < 0) place.target = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    if (place.target < 0) return system_failure(path);
    std::uint64_t begin = from;
    if (place.chunk == 0) {
        const UtcTime start = feed_.start_of(feed_.sites()[site], place.volume);
        auto done = put_header(place.source, place.target, path, start);
        if (!done) return done;
        begin = level2::archive_header_bytes;
    }
    const std::uint64_t target_at = delivery_ == Delivery::chunks ? begin - from : begin;
    auto copied = copy_range(place.source, begin, to, place.target, target_at, path);
    if (!copied) return copied;
    if (delivery_ != Delivery::open) ::close(std::exchange(place.target, -1));
    return {};
}

Status FeedPlayer::end_volume(std::size_t site, Place& place) {
    ::close(std::exchange(place.source, -1));
    if (place.target >= 0) ::close(std::exchange(place.target, -1));
    if (delivery_ != Delivery::whole) return {};
    std::error_code failed;
    const fs::path hidden = path_of(site, place.volume, false);
    fs::rename(hidden, path_of(site, place.volume, true), failed);
    if (failed) return fail(ErrorCode::io, "{}: {}", hidden.native(), failed.message());
    return {};
}

Status FeedPlayer::write_next(const std::function<void(SentVolume)>& sent) {
    const std::size_t site = due_.top().second;
    due_.pop();
    const NationalSite& sender = feed_.sites()[site];
    Place& place = places_[site];
    const NationalFile& file = feed_.file_of(sender, place.volume);
    if (place.chunk == 0) {
        if (auto begun = begin_volume(site, place); !begun) return begun;
    }
    const std::uint64_t from = place.chunk == 0 ? 0 : file.ends[place.chunk - 1];
    const std::uint64_t to = file.ends[place.chunk];
    if (auto copied = copy(site, place, from, to); !copied) return copied;
    bytes_ += to - from;
    bytes_of_kind_[static_cast<std::size_t>(sender.kind)] += to - from;
    ++chunks_;
    if (++place.chunk == file.ends.size()) {
        if (auto ended = end_volume(site, place); !ended) return ended;
        const UtcTime start = feed_.start_of(sender, place.volume);
        const cache::GridName grid{std::string(sender.station.icao), level2::Moment::ref, start};
        sent({site, place.volume, cache::relative_path(grid).filename(),
              std::chrono::steady_clock::now()});
        ++volumes_sent_[site];
        ++place.volume;
        place.chunk = 0;
    }
    const auto chunks = static_cast<double>(feed_.file_of(sender, place.volume).ends.size());
    const double part = static_cast<double>(place.chunk + 1) / chunks;
    due_.emplace(sender.first_start_s + (place.volume + part) * feed_.period_s(), site);
    return {};
}

}  // namespace stormcellar::bench

#include "bench/feed_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/measure.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::bench {
namespace {

constexpr double longest_wait_s = 0.05;
constexpr std::chrono::milliseconds between_looks{500};

double seconds_between(std::chrono::steady_clock::time_point from,
                       std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

double Stretch::latency_s(double share) const {
    if (latencies_s.empty()) return std::nan("");
    const double rank = std::ceil(share * static_cast<double>(latencies_s.size()));
    return latencies_s[std::max<std::size_t>(1, static_cast<std::size_t>(rank)) - 1];
}

Status FeedRun::send_beginnings() {
    while (player_.next_s() <= 0) {
        auto sent = player_.write_next([](const SentVolume&) {});
        if (!sent) return sent;
    }
    return {};
}

Status FeedRun::watch(const NationalFeed& feed) {
    std::vector<std::string> stations, days;
    for (const NationalSite& site : feed.sites())
        stations.emplace_back(site.station.icao);
    for (int day = -1; day <= 1; ++day)
        days.push_back(cache::day_name(national_start() + std::chrono::days{day}));
    return watch_.watch(daemon_.cache(), stations, days);
}

void FeedRun::note_grids() {
    watch_.read([this](std::string_view name) {
        const auto sent = sent_.find(std::string(name));
        if (sent == sent_.end()) return;  // of a volume that has not ended yet
        if (sent->second.latency_s < 0) {
            --unfinished_;
            int& before = gridded_[sent->second.site];
            if (before >= 0) player_.scour(sent->second.site, before);
            before = sent->second.volume;
        }
        sent->second.latency_s = seconds_between(sent->second.closed, Clock::now());
    });
}

void FeedRun::look(Stretch& stretch, Clock::time_point begin) {
    const auto now = Clock::now();
    if (now < next_look_) return;
    next_look_ = now + between_looks;
    const DaemonMemory memory = daemon_.memory();
    stretch.memory.peak_mib = std::max(stretch.memory.peak_mib, memory.peak_mib);
    stretch.memory.anonymous_mib = std::max(stretch.memory.anonymous_mib, memory.anonymous_mib);
    stretch.memory.file_mib = std::max(stretch.memory.file_mib, memory.file_mib);
    stretch.samples.push_back({seconds_between(begin, now), memory.anonymous_mib});
    stretch.last = daemon_.status();
    stretch.most_cache_bytes = std::max(stretch.most_cache_bytes, stretch.last.cache_bytes);
    stretch.most_waiting = std::max(stretch.most_waiting, stretch.last.waiting);
}

bool FeedRun::drain(double most_s) {
    const auto begin = Clock::now();
    // A file written a moment ago appears in the status a second later.
    double idle_since_s = 0;
    while (seconds_between(begin, Clock::now()) < most_s && daemon_.is_running()) {
        watch_.wait(longest_wait_s);
        note_grids();
        const DaemonStatus status = daemon_.status();
        const double now_s = seconds_between(begin, Clock::now());
        if (status.waiting + status.running > 0 || unfinished_ > 0) idle_since_s = now_s;
        if (now_s - idle_since_s > 1.5) return true;
    }
    return false;
}

// The feed's clock stops while too much is unfinished.
Status FeedRun::play(const StretchOptions& options, Stretch& stretch) {
    const auto begin = Clock::now();
    const double begin_s = feed_s_;
    auto last = begin;
    double held_for_s = 0;
    const auto sent = [&](const SentVolume& volume) {
        sent_[volume.grid] = {volume.closed, -1, volume.site, volume.volume};
        ++unfinished_;
        ++stretch.volumes;
    };
    while (feed_s_ - begin_s < options.most_feed_s &&
           seconds_between(begin, Clock::now()) < options.most_wall_s) {
        if (!daemon_.is_running()) return fail(ErrorCode::internal, "stormcellard has ended");
        const auto now = Clock::now();
        const double passed_s = seconds_between(last, now);
        last = now;
        note_grids();
        const bool held = unfinished_ > options.most_unfinished;
        if (held) {
            stretch.held_s += passed_s;
            held_for_s += passed_s;
            if (held_for_s > options.most_drain_s) break;
        } else {
            held_for_s = 0;
            feed_s_ = std::min(feed_s_ + passed_s * options.speed, begin_s + options.most_feed_s);
        }
        while (player_.next_s() <= feed_s_) {
            if (auto written = player_.write_next(sent); !written) return written;
        }
        look(stretch, begin);
        const double to_next_s = (player_.next_s() - feed_s_) / options.speed;
        watch_.wait(held ? longest_wait_s : std::clamp(to_next_s, 0.0, longest_wait_s));
    }
    stretch.feed_s = feed_s_ - begin_s;
    return {};
}

Result<Stretch> FeedRun::run(const StretchOptions& options) {
    Stretch stretch;
    sent_.clear();
    unfinished_ = 0;
    next_look_ = {};
    daemon_.reset_peak();
    const std::uint64_t bytes = player_.bytes(), chunks = player_.chunks();
    for (int kind = 0; kind < 3; ++kind)
        stretch.bytes_of_kind.push_back(player_.bytes_of_kind(kind));
    const double daemon_before_s = daemon_.cpu_s(), own_before_s = cpu_s();
    const auto begin = Clock::now();
    if (auto played = play(options, stretch); !played) return pass_on(played);
    const auto end = Clock::now();
    stretch.player_cpu_s = cpu_s() - own_before_s;

    // Waits for grids of what was sent, then for everything else to be read.
    auto busy_until = end;
    for (auto now = end; seconds_between(end, now) < options.most_drain_s; now = Clock::now()) {
        watch_.wait(longest_wait_s);
        note_grids();
        look(stretch, begin);
        if (unfinished_ + stretch.last.waiting + stretch.last.running > 0) busy_until = now;
        stretch.drained = seconds_between(busy_until, now) > 1.5;
        if (stretch.drained) break;
    }
    stretch.drain_s = seconds_between(end, busy_until);
    stretch.wall_s = seconds_between(begin, busy_until);
    stretch.daemon_cpu_s = daemon_.cpu_s() - daemon_before_s;
    stretch.bytes = player_.bytes() - bytes;
    stretch.chunks = player_.chunks() - chunks;
    for (int kind = 0; kind < 3; ++kind) {
        auto& sent = stretch.bytes_of_kind[static_cast<std::size_t>(kind)];
        sent = player_.bytes_of_kind(kind) - sent;
    }
    for (const auto& [grid, volume] : sent_) {
        if (volume.latency_s >= 0) stretch.latencies_s.push_back(volume.latency_s);
    }
    stretch.ungridded = unfinished_;
    std::sort(stretch.latencies_s.begin(), stretch.latencies_s.end());
    return stretch;
}

}  // namespace stormcellar::bench

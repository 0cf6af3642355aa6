#include "bench/feed_run.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "bench/measure.h"
#include "bench/restamp.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/catalog/catalog.h"
#include "synth/replay_turns.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double longest_wait_s = 0.05;
// The status may show a new file a second late, so the daemon counts as idle only after this time.
constexpr double idle_s = 1.5;
constexpr std::chrono::milliseconds between_looks{500};

double seconds_between(std::chrono::steady_clock::time_point from,
                       std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Status FeedRun::watch(level2::Moment moment) {
    std::vector<std::string> stations, days;
    for (const NationalSite& site : feed_.sites())
        stations.emplace_back(site.station.icao);
    for (int day = -1; day <= 1; ++day)
        days.push_back(cache::day_name(national_start() + std::chrono::days{day}));
    return watch_.watch(daemon_.cache(), stations, days, moment);
}

void FeedRun::note_grids() {
    watch_.read([this](std::string_view name) {
        const auto now = Clock::now();
        renames_[std::string(name)].push_back(now);
        const auto sent = sent_.find(std::string(name));
        if (sent == sent_.end()) return;  // the volume has not ended yet
        if (sent->second.latency_s < 0) {
            --unfinished_;
            const std::size_t volume = sent->second.volume;
            const auto [before, is_first] = last_.try_emplace(volumes_[volume].site, volume);
            std::error_code ignored;
            if (!is_first) fs::remove_all(daemon_.drop() / targets_[before->second], ignored);
            before->second = volume;
        }
        sent->second.latency_s = seconds_between(sent->second.closed, now);
    });
    gridded_.notify_all();
}

void FeedRun::look() {
    const auto now = Clock::now();
    if (now < next_look_) return;
    next_look_ = now + between_looks;
    const DaemonMemory memory = daemon_.memory();
    DaemonMemory& most = stretch_.memory;
    most.peak_mib = std::max(most.peak_mib, memory.peak_mib);
    most.anonymous_mib = std::max(most.anonymous_mib, memory.anonymous_mib);
    most.file_mib = std::max(most.file_mib, memory.file_mib);
    stretch_.samples.push_back({seconds_between(begin_, now), memory.anonymous_mib});
    stretch_.last = daemon_.status();
    stretch_.most_cache_bytes = std::max(stretch_.most_cache_bytes, stretch_.last.cache_bytes);
    stretch_.most_waiting = std::max(stretch_.most_waiting, stretch_.last.waiting);
}

// Does not count a volume that ended, and got its grid, before the feed's clock began.
void FeedRun::forget_before_the_clock(std::string_view grid) {
    const std::scoped_lock lock(mutex_);
    const auto sent = sent_.find(std::string(grid));
    if (sent == sent_.end()) return;
    --unfinished_;
    --stretch_.volumes;
    sent_.erase(sent);
}

bool FeedRun::wait_until_idle(double most_s) {
    const auto begin = Clock::now();
    auto busy = begin;
    while (seconds_between(begin, Clock::now()) < most_s && daemon_.is_running()) {
        watch_.wait(longest_wait_s);
        watch_.read([this](std::string_view name) { forget_before_the_clock(name); });
        const DaemonStatus status = daemon_.status();
        if (status.waiting + status.running > 0) busy = Clock::now();
        if (seconds_between(busy, Clock::now()) > idle_s) return true;
    }
    return false;
}

Status FeedRun::start(const StretchOptions& options, const std::string& configuration) {
    if (Status started = daemon_.start(configuration); !started) return started;
    if (!wait_until_idle(options.most_drain_s))
        fmt::print(stderr, "not all of the beginnings were read\n");
    daemon_.reset_peak();
    return {};
}

// Notes the end of a volume, and waits while too many volumes have no grid.
void FeedRun::end_volume(std::size_t volume, const StretchOptions& options) {
    const auto closed = Clock::now();
    std::unique_lock lock(mutex_);
    sent_[volumes_[volume].grid] = {closed, -1, volume};
    ++unfinished_;
    ++stretch_.volumes;
    ++stretch_.volumes_sent[volumes_[volume].site];
    const auto is_free = [&] { return stop_ || unfinished_ <= options.most_unfinished; };
    const auto most = std::chrono::duration<double>(options.most_drain_s);
    if (!gridded_.wait_for(lock, most, is_free)) stop_ = true;
    stretch_.held_s += seconds_between(closed, Clock::now());
}

void FeedRun::watch_on(const StretchOptions& options) {
    while (!is_over_) {
        watch_.wait(longest_wait_s);
        const std::scoped_lock lock(mutex_);
        note_grids();
        look();
        if (seconds_between(begin_, Clock::now()) > options.most_wall_s) stop_ = true;
    }
}

// Waits until all sent volumes have grids and the daemon is idle, at most `most_s`. Returns the
// last time at which the daemon was busy.
FeedRun::Clock::time_point FeedRun::drain(double most_s) {
    const auto begin = Clock::now();
    auto busy = begin;
    while (!stretch_.drained && seconds_between(begin, Clock::now()) < most_s) {
        std::this_thread::sleep_for(between_looks / 10);
        const std::scoped_lock lock(mutex_);
        const auto now = Clock::now();
        if (unfinished_ + stretch_.last.waiting + stretch_.last.running > 0) busy = now;
        stretch_.drained = seconds_between(busy, now) > idle_s;
    }
    return busy;
}

void FeedRun::finish(double bytes) {
    stretch_.bytes = bytes;
    stretch_.sustained = bytes / feed_.bytes_a_second() / stretch_.wall_s;
    for (const auto& [grid, volume] : sent_) {
        if (volume.latency_s >= 0) stretch_.latencies_s.push_back(volume.latency_s);
    }
    stretch_.ungridded = unfinished_;
}

Result<Stretch> FeedRun::run(const StretchOptions& options, const std::string& configuration,
                             const std::function<Status()>& begin) {
    std::error_code failed;
    fs::create_directories(daemon_.drop(), failed);
    if (Status watched = watch(options.last_moment); !watched) return pass_on(watched);
    volumes_ = feed_.volumes(options.most_feed_s, options.last_moment);
    for (const NationalVolume& volume : volumes_)
        items_.push_back(feed_.item_of(volume));
    auto targets = synth::targets_of(items_, options.delivery);
    if (!targets) return pass_on(targets);
    targets_ = std::move(*targets);
    stretch_.volumes_sent.resize(feed_.sites().size());

    Status begun = fail(ErrorCode::internal, "the feed did not begin");
    double daemon_before_s = 0, own_before_s = 0;
    std::thread watcher;
    synth::ReplayOptions replaying;
    replaying.delivery = options.delivery;
    replaying.speed = options.speed;
    replaying.stop = &stop_;
    // A whole file is delivered in one step, so no file is half sent when the clock begins.
    if (options.delivery != synth::Delivery::whole)
        replaying.past_s = feed_.past_s() / options.speed;
    replaying.stamp = [](const synth::ReplayItem& item, std::span<std::byte> bytes) {
        stamp_header_time(bytes, *item.time);
    };
    replaying.ended = [&](const synth::ReplayItem& item) {
        end_volume(static_cast<std::size_t>(&item - items_.data()), options);
    };
    double past_bytes = 0;
    replaying.begun = [&] {
        begun = start(options, configuration);
        if (begun) begun = begin();
        stop_ = !begun;
        if (!begun) return;
        for (const auto& entry : fs::recursive_directory_iterator(daemon_.drop()))
            past_bytes += entry.is_regular_file() ? static_cast<double>(entry.file_size()) : 0;
        begin_ = Clock::now();
        daemon_before_s = daemon_.cpu_s();
        own_before_s = cpu_s();
        watcher = std::thread([&] { watch_on(options); });
    };
    const auto played = synth::replay(items_, daemon_.drop(), real_file_system(), replaying);
    const auto end = Clock::now();
    stretch_.player_cpu_s = cpu_s() - own_before_s;

    const auto busy = watcher.joinable() ? drain(options.most_drain_s) : end;
    is_over_ = true;
    if (watcher.joinable()) watcher.join();
    if (!begun) return pass_on(begun);
    if (!played) return pass_on(played);
    if (!daemon_.is_running()) return fail(ErrorCode::internal, "stormcellard has ended");
    stretch_.drain_s = seconds_between(end, busy);
    stretch_.wall_s = seconds_between(begin_, busy);
    stretch_.daemon_cpu_s = daemon_.cpu_s() - daemon_before_s;
    finish(static_cast<double>(played->bytes) - past_bytes);
    return std::move(stretch_);
}

namespace {

std::size_t files_below(const fs::path& directory, const std::string& ending) {
    std::size_t files = 0;
    std::error_code problem;
    for (const auto& entry : fs::recursive_directory_iterator(directory, problem)) {
        if (entry.is_regular_file(problem) && entry.path().native().ends_with(ending)) ++files;
    }
    return files;
}

Status check_site(const NationalFeed& feed, const NationalSite& site, int sent,
                  const catalog::CatalogReader& catalog, const DaemonProcess& daemon,
                  SoakCheck& check) {
    const auto rows = catalog.list(site.station.icao, {});
    if (!rows) return pass_on(rows);
    std::set<UtcTime> known;
    for (const catalog::CatalogEntry& row : *rows) {
        ++check.rows;
        std::error_code problem;
        const bool there = fs::exists(row.path, problem);
        if (there == (row.state == catalog::FileState::gone)) ++check.wrong_rows;
        const bool settled =
            row.state == catalog::FileState::complete || row.state == catalog::FileState::gone;
        if (settled && row.volume.start_time) known.insert(*row.volume.start_time);
    }
    for (int volume = 0; volume < sent; ++volume) {
        if (!known.contains(feed.start_of(site, volume))) ++check.missing_rows;
    }
    if (sent == 0) return {};
    const cache::GridName newest{std::string(site.station.icao), level2::Moment::ref,
                                 feed.start_of(site, sent - 1)};
    std::error_code problem;
    if (!fs::exists(daemon.cache() / cache::relative_path(newest), problem)) ++check.missing_grids;
    return {};
}

}  // namespace

double memory_slope_mib_h(std::span<const MemorySample> samples) {
    samples = samples.subspan(samples.size() / 10);
    if (samples.size() < 2) return std::nan("");
    double mean_s = 0, mean_mib = 0;
    for (const MemorySample& sample : samples) {
        mean_s += sample.wall_s / static_cast<double>(samples.size());
        mean_mib += sample.anonymous_mib / static_cast<double>(samples.size());
    }
    double products = 0, squares = 0;
    for (const MemorySample& sample : samples) {
        products += (sample.wall_s - mean_s) * (sample.anonymous_mib - mean_mib);
        squares += (sample.wall_s - mean_s) * (sample.wall_s - mean_s);
    }
    return 3600 * products / squares;
}

Result<SoakCheck> check_soak(const NationalFeed& feed, const std::vector<int>& volumes_sent,
                             const DaemonProcess& daemon) {
    SoakCheck check;
    auto catalog = catalog::CatalogReader::open(daemon.catalog());
    if (!catalog) return pass_on(catalog);
    check.files = files_below(daemon.drop(), "");
    check.grids = files_below(daemon.cache(), ".scg");
    for (std::size_t i = 0; i < feed.sites().size(); ++i) {
        auto done = check_site(feed, feed.sites()[i], volumes_sent[i], *catalog, daemon, check);
        if (!done) return pass_on(done);
    }
    return check;
}

}  // namespace stormcellar::bench

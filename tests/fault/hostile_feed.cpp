#include "tests/fault/hostile_feed.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/level2/encode.h"
#include "tests/fault/feed_volume.h"
#include "tests/fault/hostile_watch.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr std::array<std::string_view, 16> stations = {
    "KTLX", "KFWS", "KINX", "KVNX", "KAMA", "KFDR", "KDYX", "KSRX",
    "KLZK", "KSHV", "KDDC", "KICT", "KTWX", "KEAX", "KSGF", "KLBB"};

constexpr int real_gates = 480;  // number of gates, each 250 m long

const FeedScene feed_scene{"KTLX",
                           35.333,
                           -97.278,
                           390,
                           {0.5, 1.5, 3, 6, 10},
                           true,
                           {{40, 25, 30, 18, 40, 4, 12, 58}, {-50, -35, 22, 15, 100, 3, 10, 50}}};

void give_to(level2::Volume& volume, std::string_view icao) {
    const auto station = find_station(icao);
    if (!station) throw std::runtime_error("a station that is not in the table");
    volume.station = std::string{icao};
    volume.header->icao = std::string{icao};
    volume.block->latitude_deg = static_cast<float>(station->latitude_deg);
    volume.block->longitude_deg = static_cast<float>(station->longitude_deg);
    volume.block->site_height_m =
        static_cast<std::int16_t>(station->antenna_altitude_m - volume.block->tower_height_m);
}

// Moves the times of the volume to `start`, and spreads its radials evenly over `takes_s`.
void move_to(level2::Volume& volume, UtcTime start, double takes_s, int number) {
    const NexradTime time = nexrad_from_time(start);
    volume.header->filename = fmt::format("AR2V0006.{:03}", number);
    volume.header->date = time.day;
    volume.header->ms = time.milliseconds;
    const double step_s = takes_s / static_cast<double>(volume.radial_count());
    std::size_t radial_number = 0;
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials) {
            const double after_s = step_s * static_cast<double>(radial_number++);
            radial.time = start + milliseconds{static_cast<std::int64_t>(1000 * after_s)};
        }
    }
}

}  // namespace

std::span<const std::string_view> real_stations() {
    return stations;
}

RealFeed::RealFeed(fs::path drop, fs::path cache, double period_s)
    : drop_(std::move(drop)), cache_(std::move(cache)), period_s_(period_s) {
    // All stations send the same observed volume.
    const level2::Volume pattern = observed_volume(text_of(feed_scene), real_gates);
    for (std::size_t i = 0; i < stations.size(); ++i) {
        Station station;
        station.pattern = pattern;
        give_to(station.pattern, stations[i]);
        station.comes_as_chunks = i % 4 == 3;
        stations_.push_back(std::move(station));
    }
}

RealFeed::~RealFeed() {
    ending_ = true;
    if (writing_.joinable()) writing_.join();
    is_watched_ = false;
    if (watching_.joinable()) watching_.join();
}

void RealFeed::begin() {
    is_watched_ = true;
    // Stations start at different times, so that they are at different places in their volumes.
    const auto now = Clock::now();
    for (std::size_t i = 0; i < stations_.size(); ++i) {
        const duration<double> after{period_s_ * static_cast<double>(i) /
                                     static_cast<double>(stations_.size())};
        stations_[i].next_piece = now + std::chrono::duration_cast<Clock::duration>(after);
    }
    writing_ = std::thread([this] { write(); });
    watching_ = std::thread([this] { watch(); });
}

void RealFeed::begin_volume(Station& station) {
    const UtcTime start = now_utc();
    const int number = ++station.number % 900;
    move_to(station.pattern, start, period_s_, number);
    const auto encoded = level2::encode(station.pattern, {.compression_level = 6});
    if (!encoded) throw std::runtime_error(encoded.error().message);
    station.pieces = pieces_of(encoded->joined());
    station.next = 0;
    const std::string icao = station.pattern.station, time = format_compact(start);
    station.volume = {icao, start, {}, {}, {}};
    if (!station.comes_as_chunks) {
        station.volume.files = {drop_ / icao / (icao + time + "_V06")};
    } else {
        for (const std::string& name : chunk_names(start, station.pieces.size()))
            station.volume.files.push_back(drop_ / icao / fmt::format("{}", number) / name);
    }
    fs::create_directories(station.volume.files.front().parent_path());
    ++begun_;
}

void RealFeed::write_piece(Station& station) {
    const auto& files = station.volume.files;
    const Status done = writer_.append(files[std::min(station.next, files.size() - 1)],
                                       station.pieces[station.next]);
    if (!done) throw std::runtime_error(done.error().message);
    const duration<double> pause{period_s_ / static_cast<double>(station.pieces.size() + 1)};
    station.next_piece += std::chrono::duration_cast<Clock::duration>(pause);
    if (++station.next < station.pieces.size()) return;
    station.volume.closed = Clock::now();
    station.next_piece += std::chrono::duration_cast<Clock::duration>(pause);
    station.pieces.clear();
    const std::scoped_lock lock(mutex_);
    closed_.push_back(station.volume);
}

// Writes the pieces of all stations in the order of their times.
void RealFeed::write() {
    while (true) {
        const auto first = std::min_element(
            stations_.begin(), stations_.end(), [this](const Station& a, const Station& b) {
                const auto due = [this](const Station& station) {
                    return ending_ && station.pieces.empty() ? Clock::time_point::max()
                                                             : station.next_piece;
                };
                return due(a) < due(b);
            });
        if (ending_ && first->pieces.empty()) return;
        const auto now = Clock::now();
        if (first->next_piece > now) {
            testing::pass_time(
                std::min<Clock::duration>(first->next_piece - now, milliseconds{50}));
            continue;
        }
        if (first->pieces.empty()) begin_volume(*first);
        write_piece(*first);
    }
}

// Opens a grid file whenever it has changed, because a living grid has the same name as the final
// grid.
void RealFeed::look_at_waiting(std::vector<std::int64_t>& seen_ns) {
    std::vector<std::pair<std::size_t, RealVolume>> waiting;
    {
        const std::scoped_lock lock(mutex_);
        seen_ns.resize(closed_.size());
        for (std::size_t i = 0; i < closed_.size(); ++i) {
            if (!closed_[i].latency_s) waiting.emplace_back(i, closed_[i]);
        }
    }
    for (const auto& [index, volume] : waiting) {
        struct stat facts {};
        const fs::path path =
            cache_ / cache::relative_path({volume.station, level2::Moment::ref, volume.time});
        if (::stat(path.c_str(), &facts) != 0) continue;
        const auto now = Clock::now();
        const std::int64_t changed_ns =
            facts.st_ctim.tv_sec * std::int64_t{1'000'000'000} + facts.st_ctim.tv_nsec;
        if (changed_ns == std::exchange(seen_ns[index], changed_ns)) continue;
        if (!has_whole_grid(cache_, volume.station, volume.time)) continue;
        const std::scoped_lock lock(mutex_);
        closed_[index].latency_s = duration<double>(now - volume.closed).count();
    }
}

void RealFeed::watch() {
    std::vector<std::int64_t> seen_ns;
    while (is_watched_) {
        look_at_waiting(seen_ns);
        testing::pass_time(milliseconds{5});
    }
}

std::vector<RealVolume> RealFeed::finish(double most_wait_s) {
    ending_ = true;
    writing_.join();
    comes_true(most_wait_s, [this] {
        const std::scoped_lock lock(mutex_);
        return std::all_of(closed_.begin(), closed_.end(),
                           [](const RealVolume& volume) { return volume.latency_s.has_value(); });
    });
    is_watched_ = false;
    watching_.join();
    return closed_;
}

}  // namespace stormcellar::fault

#include "bench/national_feed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/restamp.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_name.h"
#include "synth/replay_pieces.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double hour_s = 3600;

constexpr std::array<const char*, 3> kind_paths = {
    "chunks/L2D_230", "volumes/KLBB20160601_150025_V06", "chunks/OPENRADAR_KLOT"};
constexpr std::array<int, 8> kind_of_site = {0, 0, 1, 0, 0, 0, 2, 0};

// Reads a file, or the chunks of a directory in their order.
Result<Bytes> read_joined(const fs::path& path) {
    std::error_code problem;
    if (!fs::is_directory(path, problem)) return read_file(path);
    std::set<fs::path> chunks;
    for (const auto& entry : fs::directory_iterator(path, problem))
        chunks.insert(entry.path());
    Bytes joined;
    for (const fs::path& chunk : chunks) {
        auto bytes = read_file(chunk);
        if (!bytes) return bytes;
        joined.insert(joined.end(), bytes->begin(), bytes->end());
    }
    return joined;
}

// Returns the time of the radials: the middle of the hour, because the decoder believes only times
// within an hour of the header.
UtcTime stamp_of(int hour) {
    return national_start() + std::chrono::minutes{60 * hour + 28};
}

struct ToMake {
    Station station;
    int hour = 0;
    fs::path path;
};

Status make_files(const StampedRecords& records, const std::vector<ToMake>& files, int threads) {
    std::vector<Status> made(files.size());
    for_each_piece(static_cast<int>(files.size()), threads, [&](int piece) {
        const auto at = static_cast<std::size_t>(piece);
        const ToMake& file = files[at];
        made[at] = write_file_atomically(real_file_system(), file.path,
                                         records.stamped(file.station, stamp_of(file.hour)));
    });
    for (Status& status : made) {
        if (!status) return std::move(status);
    }
    return {};
}

Status look_at(NationalSite& site) {
    const auto bytes = read_file(site.hours.front());
    if (!bytes) return pass_on(bytes);
    site.bytes = bytes->size();
    site.chunks = synth::piece_ends(*bytes).size();
    return {};
}

std::vector<NationalSite> first_sites(int count) {
    std::vector<NationalSite> sites;
    for (const Station& station : all_stations()) {
        if (station.kind != RadarKind::nexrad || static_cast<int>(sites.size()) == count) continue;
        NationalSite site;
        site.station = station;
        site.kind = kind_of_site[sites.size() % kind_of_site.size()];
        sites.push_back(std::move(site));
    }
    return sites;
}

}  // namespace

UtcTime national_start() {
    return std::chrono::sys_days{std::chrono::year{2024} / 6 / 1} + std::chrono::minutes{30};
}

Result<NationalFeed> NationalFeed::make(int sites, int hours, const fs::path& data,
                                        const fs::path& directory, int threads) {
    std::error_code failed;
    fs::create_directories(directory, failed);
    if (failed) return fail(ErrorCode::io, "{}: {}", directory.native(), failed.message());
    NationalFeed feed;
    feed.sites_ = first_sites(sites);
    double messages = 0, bytes = 0;
    for (int kind = 0; kind < static_cast<int>(kind_paths.size()); ++kind) {
        const auto joined = read_joined(data / kind_paths[static_cast<std::size_t>(kind)]);
        if (!joined) return pass_on(joined);
        std::vector<ToMake> missing;
        int senders = 0;
        for (NationalSite& site : feed.sites_) {
            if (site.kind != kind) continue;
            ++senders;
            for (int hour = 0; hour < hours; ++hour) {
                const fs::path path =
                    directory / fmt::format("{}-{}-{:02}.ar2v", site.station.icao, kind, hour);
                if (!fs::exists(path, failed)) missing.push_back({site.station, hour, path});
                site.hours.push_back(path);
            }
        }
        const auto records = StampedRecords::read(*joined);
        if (!records) return pass_on(records);
        if (auto made = make_files(*records, missing, threads); !made) return pass_on(made);
        messages += senders * static_cast<double>(records->message_bytes());
        bytes += senders * static_cast<double>(joined->size());
    }
    feed.expansion_ = messages / bytes;
    double volume_bytes = 0;
    for (NationalSite& site : feed.sites_) {
        if (Status known = look_at(site); !known) return pass_on(known);
        volume_bytes += static_cast<double>(site.bytes);
    }
    feed.period_s_ =
        volume_bytes * hour_s /
        (heaviest_hour_bytes * static_cast<double>(feed.sites_.size()) / national_sites);
    for (std::size_t i = 0; i < feed.sites_.size(); ++i) {
        feed.sites_[i].first_start_s =
            -feed.period_s_ * static_cast<double>(i) / static_cast<double>(feed.sites_.size());
    }
    return feed;
}

double NationalFeed::chunks_a_second() const {
    double chunks = 0;
    for (const NationalSite& site : sites_)
        chunks += static_cast<double>(site.chunks);
    return chunks / period_s_;
}

double NationalFeed::bytes_a_second() const {
    double bytes = 0;
    for (const NationalSite& site : sites_)
        bytes += static_cast<double>(site.bytes);
    return bytes / period_s_;
}

UtcTime NationalFeed::start_of(const NationalSite& site, int volume) const {
    const double seconds = site.first_start_s + volume * period_s_;
    return national_start() + std::chrono::milliseconds{std::llround(1000 * seconds)};
}

std::vector<NationalVolume> NationalFeed::volumes(double until_s, level2::Moment moment) const {
    std::vector<NationalVolume> volumes;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
        const NationalSite& site = sites_[i];
        for (int number = 0; site.first_start_s + number * period_s_ < until_s; ++number) {
            const UtcTime start = start_of(site, number);
            const cache::GridName grid{std::string(site.station.icao), moment, start};
            volumes.push_back({i, number, start, cache::relative_path(grid).filename()});
        }
    }
    std::ranges::sort(volumes, {}, &NationalVolume::start);
    return volumes;
}

synth::ReplayItem NationalFeed::item_of(const NationalVolume& volume) const {
    const NationalSite& site = sites_[volume.site];
    const double begins_s = std::max(0.0, site.first_start_s + volume.number * period_s_);
    const auto hour = std::min(static_cast<std::size_t>(begins_s / hour_s), site.hours.size() - 1);
    const std::string icao(site.station.icao);
    const std::string name = fmt::format("{}{}_V06", icao, format_compact(volume.start));
    return {.source = site.hours[hour],
            .name = fs::path(icao) / name,
            .time = volume.start,
            .station = icao,
            .has_records = true};
}

}  // namespace stormcellar::bench

#include "bench/mosaic_feed.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/restamp.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "synth/observe.h"
#include "synth/synth_scene.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr int side = 256;
constexpr int levels = 128;
constexpr double level_step_m = 125;

constexpr std::string_view simulated = "simulated-";
constexpr const char* storm_line = STORMCELLAR_SOURCE_DIRECTORY "/scenes/storm-line.toml";

// The sites send these kinds, in turn.
struct FeedKind {
    std::vector<std::string> files;  // files that are sent in turn; empty: the simulated storms
    std::chrono::minutes interval{10};

    [[nodiscard]] int volumes_an_hour() const {
        return static_cast<int>(std::chrono::minutes{60} / interval);
    }
    // Returns the name of the volume that is sent as number `slot` of an hour.
    [[nodiscard]] std::string volume_at(int slot) const {
        if (files.empty()) return fmt::format("{}{}", simulated, slot);
        return files[static_cast<std::size_t>(slot) % files.size()];
    }
};

const FeedKind& kind_of(int site) {
    static const FeedKind migrating_birds{{"mosaic-northeast/KCCX20100911_013442_V03.gz"}};
    static const FeedKind drizzle{{"mosaic-northeast/KOKX20100911_011047_V03.gz"}};
    static const FeedKind coast{{"mosaic-northeast/KDIX20100911_011759_V03.gz"}};
    static const FeedKind recombined{{"mosaic-northeast/KDOX20100911_012056_V04.gz"}};
    static const FeedKind clear_air{{"volumes/KABR20050101_000745.gz"}};
    static const FeedKind sequence{
        {"sequence-kbgm/KBGM20050822_024414.gz", "sequence-kbgm/KBGM20050822_025001.gz",
         "sequence-kbgm/KBGM20050822_025549.gz", "sequence-kbgm/KBGM20050822_030243.gz",
         "sequence-kbgm/KBGM20050822_030830.gz"},
        std::chrono::minutes{6}};
    static const FeedKind storms{{}, std::chrono::minutes{5}};
    static const std::array<const FeedKind*, 10> kinds = {
        &migrating_birds, &storms, &recombined, &drizzle, &sequence,
        &storms,          &coast,  &recombined, &storms,  &clear_air};
    return *kinds[static_cast<std::size_t>(site) % kinds.size()];
}

// Returns the start of a site's volume. Starts and intervals differ between sites.
UtcTime start_of(int site, int slot) {
    const std::chrono::seconds interval = kind_of(site).interval;
    const std::chrono::seconds late = std::chrono::seconds{37} * site % interval;
    return feed_start() + late + slot * interval;
}

struct Stamp {
    Station station;
    UtcTime start;
    fs::path file;
};

fs::path file_of(const fs::path& directory, const Station& station, UtcTime start) {
    return directory / fmt::format("{}{}_V06", station.icao, format_compact(start));
}

// Returns the missing files, keyed by the volume from which each is made.
std::map<std::string, std::vector<Stamp>> missing_files(int sites, const fs::path& directory,
                                                        std::chrono::hours hours) {
    std::map<std::string, std::vector<Stamp>> missing;
    const std::vector<Station> stations = feed_sites(sites);
    for (int site = 0; site < sites; ++site) {
        const Station& station = stations[static_cast<std::size_t>(site)];
        const int an_hour = kind_of(site).volumes_an_hour();
        for (int slot = 0; slot < an_hour * hours.count(); ++slot) {
            const UtcTime start = start_of(site, slot);
            fs::path file = file_of(directory, station, start);
            std::error_code ignored;
            if (fs::exists(file, ignored)) continue;
            missing[kind_of(site).volume_at(slot % an_hour)].push_back(
                {station, start, std::move(file)});
        }
    }
    return missing;
}

Status write_stamped(const level2::Volume& volume, const Stamp& stamp) {
    level2::Volume stamped = volume;
    restamp(stamped, stamp.station, stamp.start);
    const auto encoded = level2::encode(stamped);
    if (!encoded) return pass_on(encoded);
    return write_file_atomically(real_file_system(), stamp.file, encoded->joined());
}

}  // namespace

Result<level2::Volume> feed_volume(const std::string& name, const std::filesystem::path& data) {
    if (name.starts_with(simulated)) {
        int number = 0;
        std::from_chars(name.data() + simulated.size(), name.data() + name.size(), number);
        const auto scene = synth::read_scene(storm_line);
        if (!scene) return pass_on(scene);
        return synth::observe(*scene, number);
    }
    auto decoded = level2::decode_file(data / name);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

UtcTime feed_start() {
    return std::chrono::sys_days{std::chrono::year{2024} / 6 / 1} + std::chrono::hours{12};
}

std::vector<Station> feed_sites(int count) {
    std::vector<Station> sites;
    for (const Station& station : all_stations()) {
        const bool inside = station.longitude_deg > -105 && station.longitude_deg < -67 &&
                            station.latitude_deg > 24 && station.latitude_deg < 49.5;
        if (inside && station.kind == RadarKind::nexrad) sites.push_back(station);
    }
    sites.resize(std::min(sites.size(), static_cast<std::size_t>(count)));
    return sites;
}

std::vector<FeedVolume> feed_of(int sites, const fs::path& directory, std::chrono::hours hours,
                                FeedFiles files) {
    std::vector<FeedVolume> volumes;
    const std::vector<Station> stations = feed_sites(sites);
    for (int site = 0; site < sites; ++site) {
        const int an_hour = kind_of(site).volumes_an_hour();
        for (int slot = 0; slot < an_hour * hours.count(); ++slot) {
            const int written = files == FeedFiles::every_hour ? slot : slot % an_hour;
            volumes.push_back({site, start_of(site, slot),
                               file_of(directory, stations[static_cast<std::size_t>(site)],
                                       start_of(site, written)),
                               std::chrono::hours{(slot - written) / an_hour}});
        }
    }
    std::sort(volumes.begin(), volumes.end(), [](const FeedVolume& a, const FeedVolume& b) {
        return std::pair(a.start, a.site) < std::pair(b.start, b.site);
    });
    return volumes;
}

grid::GridSpec feed_domain(int sites) {
    const std::vector<Station> stations = feed_sites(sites);
    const auto by_latitude = [](const Station& a, const Station& b) {
        return a.latitude_deg < b.latitude_deg;
    };
    const auto by_longitude = [](const Station& a, const Station& b) {
        return a.longitude_deg < b.longitude_deg;
    };
    const auto [south, north] = std::minmax_element(stations.begin(), stations.end(), by_latitude);
    const auto [west, east] = std::minmax_element(stations.begin(), stations.end(), by_longitude);
    grid::GridSpec spec = grid::default_spec((south->latitude_deg + north->latitude_deg) / 2,
                                             (west->longitude_deg + east->longitude_deg) / 2);
    const grid::GridProjection plane(spec);
    double farthest_m = 0;
    for (const Station& station : stations) {
        const auto at = plane.to_column({station.latitude_deg, station.longitude_deg});
        farthest_m = std::max({farthest_m, std::abs(at.x - spec.center_x()) * spec.spacing_m,
                               std::abs(at.y - spec.center_y()) * spec.spacing_m});
    }
    spec.nx = spec.ny = side;
    spec.spacing_m = std::ceil(2 * (farthest_m + grid::site_reach_m) / side);
    spec.levels_m.clear();
    for (int level = 1; level <= levels; ++level)
        spec.levels_m.push_back(level * level_step_m);
    return spec;
}

void FeedSize::add(std::uint64_t compressed_bytes, std::uint64_t uncompressed_bytes) {
    constexpr std::uint64_t dense_expansion = 8;
    compressed += compressed_bytes;
    uncompressed += uncompressed_bytes;
    if (uncompressed_bytes <= dense_expansion * compressed_bytes) dense += uncompressed_bytes;
}

Status make_feed(int sites, const fs::path& data, const fs::path& directory, int threads,
                 std::chrono::hours hours) {
    std::error_code failed;
    fs::create_directories(directory, failed);
    if (failed) return fail(ErrorCode::io, "{}: {}", directory.string(), failed.message());
    for (const auto& missing : missing_files(sites, directory, hours)) {
        const std::vector<Stamp>& stamps = missing.second;
        const auto volume = feed_volume(missing.first, data);
        if (!volume) return pass_on(volume);
        std::vector<Status> written(stamps.size());
        for_each_piece(static_cast<int>(stamps.size()), threads, [&](int piece) {
            const auto at = static_cast<std::size_t>(piece);
            written[at] = write_stamped(*volume, stamps[at]);
        });
        for (Status& status : written) {
            if (!status) return std::move(status);
        }
    }
    return {};
}

}  // namespace stormcellar::bench

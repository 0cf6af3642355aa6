#include "bench/made_archive.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes between_volumes{5};
constexpr std::size_t rows_at_once = 5000;
// ext4 takes 65,000 names of a file.
constexpr std::size_t most_links = 60'000;

catalog::FileFacts row_of(const std::string& station, const fs::path& path, UtcTime start,
                          std::size_t number) {
    constexpr std::uint64_t scatter = 0x9E37'79B9'7F4A'7C15;
    catalog::FileFacts facts;
    facts.path = path;
    facts.station = station;
    facts.size_bytes = 4'000'000 + number * 37 % 3'000'000;
    facts.modified_ns = (start + between_volumes).time_since_epoch().count() * 1'000'000;
    facts.content_hash = scatter * (number + 1);
    facts.state = catalog::FileState::complete;
    return facts;
}

catalog::VolumeFacts volume_of(UtcTime start, std::size_t number) {
    catalog::VolumeFacts volume;
    volume.start_time = start;
    volume.end_time = start + between_volumes;
    volume.volume_number = static_cast<int>(number % 1000);
    volume.vcp = 212;
    volume.sweep_count = 14;
    volume.radial_count = 6480;
    volume.complete = true;
    return volume;
}

// 64 x 64 x 16 cells of a round shower, so that some bricks are stored and some are not.
grid::Grid small_shower(level2::Moment moment, const std::string& station, UtcTime time) {
    constexpr int edge = 64, levels = 16;
    constexpr double radius_cells = 20;
    grid::Grid made;
    made.moment = moment;
    made.time = made.start_time = time;
    made.end_time = time + between_volumes;
    const auto site = find_station(station);
    made.spec.center_latitude_deg = site->latitude_deg;
    made.spec.center_longitude_deg = site->longitude_deg;
    made.spec.nx = made.spec.ny = edge;
    for (int level = 1; level <= levels; ++level)
        made.spec.levels_m.push_back(1000.0 * level);
    made.sites = {{station, site->latitude_deg, site->longitude_deg, site->antenna_altitude_m}};
    made.provenance.stations = {station};
    made.provenance.software_version = "bench";
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::no_echo);
    for (int z = 0; z < levels; ++z) {
        for (int y = 0; y < edge; ++y) {
            for (int x = 0; x < edge; ++x) {
                const double away = std::hypot(x - edge / 2, y - edge / 2);
                if (away > radius_cells) continue;
                const std::size_t at = made.spec.index(x, y, z);
                made.status[at] = grid::CellStatus::value;
                made.values[at] = static_cast<float>(50 - 2 * away);
            }
        }
    }
    return made;
}

// Writes the grid under its own name, in a cache of its own. Returns the path of the file.
Result<fs::path> write_source(const grid::Grid& made, const fs::path& directory) {
    auto store = cache::StoreWriter::open(real_file_system(), directory, false);
    if (!store) return pass_on(store);
    const auto bricks = grid::BrickGrid::from(made, grid::default_quantization(made.moment));
    return store->commit(made.sites.front().icao, cache::describe(made), bricks.view());
}

std::string text_of(const ArchiveSize& size) {
    return fmt::format("{} stations, {} rows each, and one of chunks; {} grids\n", size.stations,
                       size.volumes_of_a_station, size.grids);
}

}  // namespace

MadeArchive::MadeArchive(fs::path directory, ArchiveSize size)
    : directory_(std::move(directory)), size_(size) {
    for (const Station& station : all_stations()) {
        if (station.kind != RadarKind::nexrad) continue;
        station_of_chunks_ = station.icao;
        if (stations_.size() == size.stations) break;
        stations_.emplace_back(station.icao);
    }
}

UtcTime MadeArchive::start_of(std::size_t volume) const {
    constexpr UtcTime first{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1}};
    return first + static_cast<int>(volume) * between_volumes;
}

std::size_t MadeArchive::volumes_of_chunks() const {
    return size_.volumes_of_a_station / chunks_of_a_volume;
}

std::size_t MadeArchive::grids_of_a_moment() const {
    const std::size_t places = stations_.size() * std::size(moments);
    return std::min(size_.grids / places, size_.volumes_of_a_station);
}

Result<MadeArchive> MadeArchive::make(const fs::path& directory, ArchiveSize size) {
    MadeArchive archive(directory, size);
    const fs::path mark = directory / "archive.txt";
    std::string made;
    std::getline(std::ifstream(mark), made, '\0');
    if (made == text_of(size)) return archive;
    if (!made.empty())
        return fail(ErrorCode::bad_argument, "{}: has an archive of another size",
                    directory.native());
    if (Status filled = archive.fill_catalog(); !filled) return pass_on(filled);
    if (Status filled = archive.fill_cache(); !filled) return pass_on(filled);
    std::ofstream(mark) << text_of(size);
    return archive;
}

Status MadeArchive::fill_catalog() const {
    std::error_code error;
    fs::create_directories(drop(), error);
    catalog::CatalogOptions options;
    options.drop = fs::canonical(drop(), error);
    auto writer = catalog::CatalogWriter::open(catalog(), options);
    if (!writer) return pass_on(writer);
    for (const std::string& station : stations_) {
        std::vector<catalog::FileFacts> rows;
        for (std::size_t i = 0; i < size_.volumes_of_a_station; ++i) {
            const UtcTime start = start_of(i);
            const std::string name = fmt::format("{}{}_V06", station, format_compact(start));
            rows.push_back(row_of(station, options.drop / station / name, start, i));
            rows.back().volumes = {volume_of(start, i)};
            if (rows.size() < rows_at_once && i + 1 < size_.volumes_of_a_station) continue;
            if (Status taken = writer->register_files(station, rows); !taken) return taken;
            rows.clear();
        }
    }
    return fill_with_chunks(*writer);
}

// Of the chunks of a volume only the first has the volume in its row.
Status MadeArchive::fill_with_chunks(catalog::CatalogWriter& writer) const {
    const fs::path directory = fs::canonical(drop()) / station_of_chunks_;
    for (std::size_t i = 0; i < volumes_of_chunks(); ++i) {
        const UtcTime start = start_of(i);
        std::string time = format_compact(start);
        std::ranges::replace(time, '_', '-');
        std::vector<catalog::FileFacts> rows;
        for (std::size_t number = 1; number <= chunks_of_a_volume; ++number) {
            const char kind = number == 1 ? 'S' : number < chunks_of_a_volume ? 'I' : 'E';
            rows.push_back(row_of(station_of_chunks_,
                                  directory / fmt::format("{}-{:03}-{}", time, number, kind), start,
                                  i * chunks_of_a_volume + number));
        }
        rows.front().volumes = {volume_of(start, i)};
        if (Status taken = writer.register_files(station_of_chunks_, rows); !taken) return taken;
    }
    return {};
}

Status MadeArchive::fill_cache() const {
    const std::size_t count = grids_of_a_moment();
    const std::size_t first = size_.volumes_of_a_station - count;
    std::size_t links = most_links;
    fs::path source;
    for (const std::string& station : stations_) {
        for (const level2::Moment moment : moments) {
            for (std::size_t i = first; i < size_.volumes_of_a_station; ++i) {
                if (links++ == most_links) {
                    auto written = write_source(small_shower(moment, station, start_of(i)),
                                                directory_ / "sources");
                    if (!written) return pass_on(written);
                    source = *std::move(written);
                    links = 1;
                }
                const fs::path path =
                    cache() / cache::relative_path({station, moment, start_of(i)});
                std::error_code error;
                fs::create_directories(path.parent_path(), error);
                fs::create_hard_link(source, path, error);
                if (error) return fail(ErrorCode::io, "{}: {}", path.native(), error.message());
            }
        }
    }
    return {};
}

}  // namespace stormcellar::bench

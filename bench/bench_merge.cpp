// bench_merge: what a mosaic costs, and bringing it up to date with one site's new volume.
//
// usage: bench_merge [--data DIR] [--threads N] [--runs N] [--json]      (bench/request.h)
// First the neighbouring sites of DIR/mosaic-northeast on one grid of 1 km, 32 levels, then 160
// sites on the grid of the United States at 0.01 degrees (7000 x 3500 x 33) with made-up storms in
// some 7 % of each site's bricks, the new volume being a real one of DIR/volumes, moved. A row:
//   case        northeast or us
//   sites       how many partials there are
//   overlap     the rule
//   threads     for all phases
//   decode_cpu, grid_cpu, bricks_cpu   the new volume: decoded (REF alone), gridded on its window
//               with the geometry kept, turned into bricks
//   update_cpu  its partial merged into the mosaic: touched bricks merged, the others copied
//   sum_cpu     all of that: seconds of CPU time by all threads, least of the runs
//   merge_cpu   the mosaic merged anew from all partials
//   update_s, merge_s   wall-clock seconds of both
//   once_cpu    kept for a site: azimuths and arcs of its window, and distances
//   touched     columns of bricks merged by the update, of how many there are
//   stored      part of the updated site's bricks that hold values
//   others_stored  the same of all partials, on average
//   mosaic_mib  memory of the mosaic's written pages, table and states
//   peak_mib    most memory of the process so far, all partials included
#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/file_system.h"
#include "base/memory.h"
#include "base/station_table.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "grid/column_geometry.h"
#include "grid/gridder.h"
#include "grid/mosaic.h"
#include "grid/projection.h"
#include "level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using grid::GridSpec;
using grid::GridWindow;
using grid::SitePosition;

double cpu_s() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
template <class Work>
void keep_least_cpu(double& least, Work work) {
    const double start_s = cpu_s();
    work();
    least = std::min(least, cpu_s() - start_s);
}

Result<level2::Volume> decode_ref(const Bytes& bytes, std::string_view station, int threads) {
    level2::DecodeOptions options;
    if (find_station(station)) options.fallback_station = std::string(station);
    options.threads = threads;
    options.selection.moments = {level2::Moment::ref};
    auto decoded = level2::decode(bytes, options);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

SitePosition position_of(const Station& station) {
    return {std::string(station.icao), station.latitude_deg, station.longitude_deg,
            station.antenna_altitude_m};
}

// A site's new volume, and what is kept for its site.
struct Newcomer {
    Bytes bytes;
    SitePosition site;
    GridWindow window;
    std::shared_ptr<const grid::ColumnGeometry> geometry;
    std::shared_ptr<const grid::SiteDistance> distance;
    double once_cpu = 0;
};

struct Least {
    double decode = HUGE_VAL, grid = HUGE_VAL, bricks = HUGE_VAL, update = HUGE_VAL;
    double sum = HUGE_VAL, merge = HUGE_VAL, update_s = HUGE_VAL, merge_s = HUGE_VAL;
};

Newcomer prepare(const GridSpec& domain, const fs::path& file, const SitePosition& site) {
    Newcomer newcomer{*read_file(file), site, {}, nullptr, nullptr, 0};
    const double start_s = cpu_s();
    newcomer.window = *grid::site_window(domain, site);
    newcomer.geometry =
        grid::make_column_geometry(site, grid::window_spec(domain, newcomer.window)).value();
    newcomer.distance = std::make_shared<const grid::SiteDistance>(domain, newcomer.window, site);
    newcomer.once_cpu = cpu_s() - start_s;
    return newcomer;
}

// From bytes to bricks.
grid::BrickGrid bricks_of(const Newcomer& from, std::string_view station, int threads,
                          Least& least) {
    Result<level2::Volume> volume = fail(ErrorCode::empty, "");
    keep_least_cpu(least.decode, [&] { volume = decode_ref(from.bytes, station, threads); });
    Result<grid::Grid> made = fail(ErrorCode::empty, "");
    grid::GridderOptions options;
    options.threads = threads;
    keep_least_cpu(least.grid,
                   [&] { made = grid::make_grid(*volume, from.site, *from.geometry, options); });
    std::optional<grid::BrickGrid> bricks;
    keep_least_cpu(least.bricks, [&] {
        bricks = grid::BrickGrid::from(*made, grid::default_quantization(level2::Moment::ref));
    });
    return *std::move(bricks);
}

double memory_mib(const grid::BrickView& view) {
    const auto stored = std::count_if(
        view.bricks.begin(), view.bricks.end(),
        [](const grid::BrickEntry& entry) { return entry.kind == grid::BrickKind::stored; });
    const std::size_t bytes = static_cast<std::size_t>(stored) * grid::brick_cells *
                                  static_cast<std::size_t>(view.quantization.code_bytes) +
                              view.bricks.size_bytes() + view.states.size();
    return static_cast<double>(bytes) / mebibyte;
}

double stored_part(const grid::BrickView& view) {
    const auto stored = std::count_if(
        view.bricks.begin(), view.bricks.end(),
        [](const grid::BrickEntry& entry) { return entry.kind == grid::BrickKind::stored; });
    return static_cast<double>(stored) / static_cast<double>(view.bricks.size());
}

void measure(const std::string& name, const GridSpec& domain, std::vector<grid::Partial> partials,
             const Newcomer& newcomer, std::string_view station, grid::Overlap overlap, int threads,
             int runs, Table& table) {
    grid::MosaicOptions options;
    options.overlap = overlap;
    options.threads = threads;
    Least least;
    double mosaic_mib = 0;
    double stored = 0;
    for (int run = 0; run < runs; ++run) {
        Result<grid::Mosaic> mosaic = fail(ErrorCode::empty, "");
        least.merge_s = std::min(least.merge_s, seconds_of([&] {
                                     keep_least_cpu(least.merge, [&] {
                                         mosaic = grid::merge(domain, partials, options);
                                     });
                                 }));
        const double start_s = cpu_s();
        const grid::BrickGrid bricks = bricks_of(newcomer, station, threads, least);
        std::vector<grid::Partial> all = partials;
        for (grid::Partial& partial : all) {
            if (partial.site.icao == newcomer.site.icao) partial.view = bricks.view();
        }
        Result<grid::Mosaic> updated = fail(ErrorCode::empty, "");
        least.update_s = std::min(
            least.update_s, seconds_of([&] {
                keep_least_cpu(least.update, [&] {
                    updated = grid::update(mosaic->view(), all, {&newcomer.window, 1}, options);
                });
            }));
        least.sum = std::min(least.sum, cpu_s() - start_s);
        mosaic_mib = memory_mib(updated.value().cells.view());
        stored = stored_part(bricks.view());
    }
    double others = 0;
    for (const grid::Partial& partial : partials)
        others += stored_part(partial.view);
    const int touched =
        grid::bricks_along(newcomer.window.nx) * grid::bricks_along(newcomer.window.ny);
    const int columns = grid::bricks_along(domain.nx) * grid::bricks_along(domain.ny);
    table.add({{"case", name},
               {"sites", static_cast<int>(partials.size())},
               {"overlap", grid::overlap_name(overlap)},
               {"threads", threads},
               {"decode_cpu", {least.decode, 3}},
               {"grid_cpu", {least.grid, 3}},
               {"bricks_cpu", {least.bricks, 3}},
               {"update_cpu", {least.update, 3}},
               {"sum_cpu", {least.sum, 3}},
               {"merge_cpu", {least.merge, 3}},
               {"update_s", {least.update_s, 3}},
               {"merge_s", {least.merge_s, 3}},
               {"once_cpu", {newcomer.once_cpu, 3}},
               {"touched", fmt::format("{}/{}", touched, columns)},
               {"stored", {stored, 3}},
               {"others_stored", {others / static_cast<double>(partials.size()), 3}},
               {"mosaic_mib", {mosaic_mib, 0}},
               {"peak_mib", {static_cast<double>(high_water_kib()) / 1024, 0}}});
}

// ---------------------------------------------------------------------------------------------
// Real neighbours.

GridSpec northeast_grid() {
    GridSpec spec = grid::default_spec(41.5, -75);
    spec.nx = 1280;
    spec.ny = 1280;
    return spec;
}

void measure_northeast(const fs::path& data, const Request& request, Table& table) {
    const GridSpec domain = northeast_grid();
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(data / "mosaic-northeast"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::deque<Newcomer> newcomers;
    std::deque<grid::BrickGrid> grids;
    std::vector<grid::Partial> partials;
    for (const fs::path& file : files) {
        const auto station = find_station(file.filename().string().substr(0, 4));
        if (!station) continue;
        newcomers.push_back(prepare(domain, file, position_of(*station)));
        Least none;
        grids.push_back(bricks_of(newcomers.back(), station->icao, 2, none));
        partials.push_back({grids.back().view(), newcomers.back().site, newcomers.back().distance});
        if (partials.size() < 2) continue;
        const bool last = file == files.back();
        for (const grid::Overlap overlap : {grid::Overlap::distance_weighted, grid::Overlap::mean,
                                            grid::Overlap::maximum, grid::Overlap::nearest}) {
            if (!last && overlap != grid::Overlap::distance_weighted) continue;
            for (const int threads : request.threads) {
                measure("northeast", domain, partials, newcomers.front(),
                        newcomers.front().site.icao, overlap, threads, request.runs, table);
            }
        }
    }
}

// ---------------------------------------------------------------------------------------------
// The United States, with made-up storms.

GridSpec us_grid() {
    GridSpec spec = grid::default_spec(37.5, -95);
    spec.projection = grid::Projection::latitude_longitude;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.01;
    spec.nx = 7000;
    spec.ny = 3500;
    // Of MRMS: 0.5 to 3 km by 0.25, to 9 km by 0.5, to 19 km by 1.
    spec.levels_m.clear();
    for (int level = 2; level <= 12; ++level)
        spec.levels_m.push_back(250.0 * level);
    for (int level = 7; level <= 18; ++level)
        spec.levels_m.push_back(500.0 * level);
    for (int level = 10; level <= 19; ++level)
        spec.levels_m.push_back(1000.0 * level);
    return spec;
}

// How high storms stand over a column, in metres; none below 0. The same for all sites.
double storm_top_m(int ix, int iy) {
    const auto wave = [](double at) { return std::sin(at); };
    const double field = wave(ix / 97.0) * wave(iy / 71.0) + 0.6 * wave(ix / 31.0 + iy / 43.0) +
                         0.3 * wave(ix / 13.0) * wave(iy / 11.0);
    return 12000 * field - 1500;
}

// Beams of 0.5 and 19.5 degrees over the 4/3 earth.
struct Seen {
    double bottom_m, top_m;
};
Seen seen_at(double arc_m, double altitude_m) {
    constexpr double radius_m = 8.5e6;
    const double fall_m = altitude_m + arc_m * arc_m / (2 * radius_m);
    return {arc_m * 0.0087 + fall_m, arc_m * 0.354 + fall_m};
}

grid::BrickGrid made_up(const GridSpec& domain, const GridWindow& window,
                        const grid::SiteDistance& distance, const SitePosition& site) {
    grid::BrickGrid made(grid::window_spec(domain, window),
                         grid::default_quantization(level2::Moment::ref));
    grid::BricksWriter writer(made);
    const grid::BrickView shape = made.view();
    std::array<std::uint8_t, grid::brick_cells> codes{};
    grid::ColumnValues squared_m2{};
    std::array<double, grid::brick_columns> tops_m{};
    for (int bx = 0; bx < shape.bricks_x; ++bx) {
        for (int by = 0; by < shape.bricks_y; ++by) {
            const int domain_bx = bx + window.first_x / grid::brick_edge;
            const int domain_by = by + window.first_y / grid::brick_edge;
            distance.squared_arcs_m2(domain_bx, domain_by, squared_m2);
            for (int c = 0; c < 256; ++c) {
                tops_m[static_cast<std::size_t>(c)] =
                    storm_top_m(domain_bx * 16 + c / 16, domain_by * 16 + c % 16);
            }
            for (int bz = 0; bz < shape.bricks_z; ++bz) {
                const grid::BrickExtent extent = grid::brick_extent(made.spec(), bx, by, bz);
                codes.fill(0);
                for (int x = 0; x < extent.x; ++x) {
                    for (int y = 0; y < extent.y; ++y) {
                        const auto c = static_cast<std::size_t>(x * 16 + y);
                        const double arc_m = std::sqrt(static_cast<double>(squared_m2[c]));
                        if (arc_m > 460e3) continue;
                        const Seen seen = seen_at(arc_m, site.altitude_m);
                        for (int z = 0; z < extent.z; ++z) {
                            const double level_m =
                                domain.levels_m[static_cast<std::size_t>(bz * 16 + z)];
                            if (level_m < seen.bottom_m || level_m > seen.top_m) continue;
                            const double under_m = tops_m[c] - level_m;
                            codes[c * 16 + static_cast<std::size_t>(z)] =
                                under_m < 0 ? 1
                                            : static_cast<std::uint8_t>(
                                                  70 + std::min(100.0, under_m / 100));
                        }
                    }
                }
                writer.put_codes(shape.brick_index(bx, by, bz), codes.data(), extent);
            }
        }
    }
    made.finish({&writer, 1});
    return made;
}

void measure_us(const fs::path& data, const Request& request, Table& table) {
    const GridSpec domain = us_grid();
    const fs::path file = data / "volumes/KLOT20220317_000842_V06";
    const Newcomer newcomer = prepare(domain, file, position_of(*find_station("KDMX")));
    std::deque<grid::BrickGrid> grids;
    std::vector<grid::Partial> partials;
    const auto add = [&](const SitePosition& site, const GridWindow& window,
                         std::shared_ptr<const grid::SiteDistance> distance) {
        grids.push_back(made_up(domain, window, *distance, site));
        partials.push_back({grids.back().view(), site, std::move(distance)});
    };
    add(newcomer.site, newcomer.window, newcomer.distance);
    constexpr std::size_t all = 160;
    for (const Station& station : all_stations()) {
        if (partials.size() == all) break;
        const SitePosition site = position_of(station);
        const auto window = grid::site_window(domain, site);
        const auto column =
            grid::GridProjection(domain).to_column({site.latitude_deg, site.longitude_deg});
        const bool inside =
            column.x > 0 && column.x < domain.nx && column.y > 0 && column.y < domain.ny;
        if (!window || !inside || site.icao == newcomer.site.icao) continue;
        add(site, *window, std::make_shared<const grid::SiteDistance>(domain, *window, site));
    }
    for (const int threads : request.threads) {
        measure("us", domain, partials, newcomer, "KLOT", grid::Overlap::distance_weighted, threads,
                request.runs, table);
    }
}

int run(int argc, char** argv) {
    keep_freed_memory();
    const auto [request, usage_status] = read_request(
        {"bench_merge", "", "what a mosaic of many sites costs", {"--northeast", "--us"}},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    Table table(request->json);
    const fs::path data = request->data.value_or("../shared/data");
    if (!request->has("--us")) measure_northeast(data, *request, table);
    if (!request->has("--northeast")) measure_us(data, *request, table);
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}

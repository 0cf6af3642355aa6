#include "bench/nation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/measure.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/mosaic.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using grid::GridSpec;
using grid::GridWindow;

constexpr std::size_t all_sites = 160;
constexpr int stripes = 8;  // the mosaic is made stripe by stripe, so that few files are open

GridSpec nation_grid() {
    GridSpec spec = grid::default_spec(37.5, -95);
    spec.projection = grid::Projection::latitude_longitude;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.01;
    spec.nx = 7000;
    spec.ny = 3500;
    spec.levels_m.clear();
    for (int level = 2; level <= 12; ++level)
        spec.levels_m.push_back(250.0 * level);
    for (int level = 7; level <= 18; ++level)
        spec.levels_m.push_back(500.0 * level);
    for (int level = 10; level <= 19; ++level)
        spec.levels_m.push_back(1000.0 * level);
    return spec;
}

// Returns the height of the top of storms over a column, which is the same for all sites. A height
// below 0 means that there is no storm.
double storm_top_m(int ix, int iy) {
    const double field = std::sin(ix / 97.0) * std::sin(iy / 71.0) +
                         0.6 * std::sin(ix / 31.0 + iy / 43.0) +
                         0.3 * std::sin(ix / 13.0) * std::sin(iy / 11.0);
    return 12000 * field - 1500;
}

// Returns the code of a cell. The site sees a cell between its beams of 0.5 and 19.5 degrees over
// an earth of 4/3 radius.
std::uint8_t code_of(double arc_m, double top_m, double altitude_m, double level_m) {
    constexpr double radius_m = 8.5e6;
    const double fall_m = altitude_m + arc_m * arc_m / (2 * radius_m);
    if (arc_m > grid::site_reach_m || level_m < arc_m * 0.0087 + fall_m ||
        level_m > arc_m * 0.354 + fall_m)
        return 0;
    if (level_m > top_m) return 1;
    return static_cast<std::uint8_t>(70 + std::min(100.0, (top_m - level_m) / 100));
}

struct PlacedSite {
    grid::SitePosition site;
    GridWindow window;
    std::shared_ptr<const grid::SiteDistance> distance;
};

grid::BrickGrid storms_at(const GridSpec& domain, const PlacedSite& placed) {
    grid::BrickGrid made(grid::window_spec(domain, placed.window),
                         grid::default_quantization(level2::Moment::ref));
    grid::BricksWriter writer(made);
    const grid::BrickView shape = made.view();
    constexpr int edge = grid::brick_edge;
    for (std::size_t brick = 0; brick < shape.bricks.size(); ++brick) {
        const int bz = static_cast<int>(brick) % shape.bricks_z;
        const int by = static_cast<int>(brick) / shape.bricks_z % shape.bricks_y;
        const int bx = static_cast<int>(brick) / shape.bricks_z / shape.bricks_y;
        const grid::BrickExtent extent = grid::brick_extent(made.spec(), bx, by, bz);
        const int x = bx * edge + placed.window.first_x, y = by * edge + placed.window.first_y;
        grid::ColumnValues squared_m2{};
        placed.distance->squared_arcs_m2(x / edge, y / edge, squared_m2);
        std::array<std::uint8_t, grid::brick_cells> codes{};
        for (int column = 0; column < static_cast<int>(grid::brick_columns); ++column) {
            if (column / edge >= extent.x || column % edge >= extent.y) continue;
            const auto at = static_cast<std::size_t>(column);
            const double arc_m = std::sqrt(static_cast<double>(squared_m2[at]));
            const double top_m = storm_top_m(x + column / edge, y + column % edge);
            for (int z = 0; z < extent.z; ++z) {
                codes[at * edge + static_cast<std::size_t>(z)] =
                    code_of(arc_m, top_m, placed.site.altitude_m,
                            domain.levels_m[static_cast<std::size_t>(bz * edge + z)]);
            }
        }
        writer.put_codes(brick, codes.data(), extent);
    }
    made.finish({&writer, 1});
    return made;
}

bool touch(const GridWindow& one, const GridWindow& other) {
    return one.first_x < other.end_x() && other.first_x < one.end_x() &&
           one.first_y < other.end_y() && other.first_y < one.end_y();
}

// The partials of all sites, as files.
class Nation {
  public:
    // The first site is the radar of the new volume.
    Nation(GridSpec domain, fs::path directory, const Station& first)
        : domain_(std::move(domain)), directory_(std::move(directory)) {
        add(position_of(first));
        const grid::GridProjection projection(domain_);
        for (const Station& station : all_stations()) {
            const auto column = projection.to_column({station.latitude_deg, station.longitude_deg});
            const bool inside =
                column.x > 0 && column.x < domain_.nx && column.y > 0 && column.y < domain_.ny;
            if (inside && station.icao != first.icao && sites_.size() < all_sites)
                add(position_of(station));
        }
    }
    [[nodiscard]] const GridSpec& domain() const { return domain_; }
    [[nodiscard]] const std::vector<PlacedSite>& sites() const { return sites_; }

    // Makes the files that are missing.
    [[nodiscard]] Status make_files() const {
        std::error_code failed;
        fs::create_directories(directory_, failed);
        for (const PlacedSite& placed : sites_) {
            if (fs::exists(path_of(placed), failed)) continue;
            const grid::BrickGrid made = storms_at(domain_, placed);
            cache::GridDescription description;
            description.spec = made.spec();
            description.sites = {placed.site};
            const auto written = cache::write_grid_file(real_file_system(), path_of(placed),
                                                        description, made.view());
            if (!written) return pass_on(written);
        }
        return {};
    }
    // Returns the partials that meet the window; valid until the next call.
    Result<std::vector<grid::Partial>> partials_in(const GridWindow& window) {
        open_.clear();
        std::vector<grid::Partial> partials;
        for (const PlacedSite& placed : sites_) {
            if (!touch(placed.window, window)) continue;
            auto opened = cache::GridFile::open(path_of(placed));
            if (!opened) return pass_on(opened);
            open_.push_back(std::move(*opened));
            partials.push_back({open_.back().view(), placed.site, placed.distance});
        }
        return partials;
    }
    Result<grid::Mosaic> merge(const grid::MosaicOptions& options) {
        auto mosaic = grid::merge(domain_, {}, options);
        const int bricks = (grid::bricks_along(domain_.nx) + stripes - 1) / stripes;
        const int width = bricks * grid::brick_edge;
        for (int x = 0; mosaic && x < domain_.nx; x += width) {
            const GridWindow stripe{x, 0, std::min(width, domain_.nx - x), domain_.ny};
            const auto partials = partials_in(stripe);
            if (!partials) return pass_on(partials);
            const Status done = grid::update_in_place(*mosaic, *partials, {&stripe, 1}, options);
            if (!done) return pass_on(done);
        }
        return mosaic;
    }

  private:
    void add(grid::SitePosition site) {
        const auto window = grid::site_window(domain_, site);
        if (!window) return;
        auto distance = std::make_shared<const grid::SiteDistance>(domain_, *window, site);
        sites_.push_back({std::move(site), *window, std::move(distance)});
    }
    [[nodiscard]] fs::path path_of(const PlacedSite& placed) const {
        return directory_ / fmt::format("{}.grid", placed.site.icao);
    }

    GridSpec domain_;
    fs::path directory_;
    std::vector<PlacedSite> sites_;
    std::deque<cache::GridFile> open_;
};

// The least times of the runs, in seconds: wall time for names with _s, else CPU time.
struct Least {
    double update = HUGE_VAL, sum = HUGE_VAL, merge = HUGE_VAL;
    double update_s = HUGE_VAL, merge_s = HUGE_VAL;
};

template <class Work>
void keep_both(double& least_cpu, double& least_s, Work work) {
    const double before_s = cpu_s();
    keep_least_seconds(least_s, work);
    least_cpu = std::min(least_cpu, cpu_s() - before_s);
}

// Merges the mosaic, and then the new volume in place of its site's previous volume.
Result<grid::Mosaic> run_once(Nation& nation, const Bytes& bytes,
                              const grid::ColumnGeometry& geometry, int threads, Least& least) {
    const PlacedSite& placed = nation.sites().front();
    grid::MosaicOptions options;
    options.threads = threads;
    Result<grid::Mosaic> mosaic = fail(ErrorCode::empty, "");
    keep_both(least.merge, least.merge_s, [&] { mosaic = nation.merge(options); });
    if (!mosaic) return mosaic;
    const double begin_s = cpu_s();
    const auto volume = decode_ref(bytes, "KLOT", threads);
    if (!volume) return pass_on(volume);
    grid::GridderOptions gridding;
    gridding.threads = threads;
    const auto made = grid::make_grid(*volume, placed.site, geometry, gridding);
    if (!made) return pass_on(made);
    const auto bricks =
        grid::BrickGrid::from(*made, grid::default_quantization(level2::Moment::ref));
    Status updated;
    keep_both(least.update, least.update_s, [&] {
        auto partials = nation.partials_in(placed.window);
        if (partials) {
            partials->front().view = bricks.view();
            updated = grid::update_in_place(*mosaic, *partials, {&placed.window, 1}, options);
        } else {
            updated = pass_on(partials);
        }
    });
    if (!updated) return pass_on(updated);
    least.sum = std::min(least.sum, cpu_s() - begin_s);
    return mosaic;
}

Status commit(const grid::Mosaic& mosaic, const fs::path& cache) {
    auto store = cache::StoreWriter::open(real_file_system(), cache, false);
    if (!store) return pass_on(store);
    cache::GridDescription description;
    description.spec = mosaic.cells.spec();
    description.time = description.start_time = description.end_time =
        UtcTime{std::chrono::sys_days{std::chrono::year{2020} / 6 / 1}};
    const auto written = store->commit("US", description, mosaic.cells.view());
    if (!written) return pass_on(written);
    return {};
}

}  // namespace

Status measure_nation(const Request& request, const fs::path& work,
                      const std::optional<fs::path>& cache, Table& table) {
    const auto bytes = read_file(request.data_directory() / "volumes/KLOT20220317_000842_V06");
    if (!bytes) return pass_on(bytes);
    Nation nation(nation_grid(), work / "us", *find_station("KDMX"));
    if (Status made = nation.make_files(); !made) return made;
    const PlacedSite& placed = nation.sites().front();
    const auto geometry =
        grid::make_column_geometry(placed.site, grid::window_spec(nation.domain(), placed.window));
    if (!geometry) return pass_on(geometry);
    Result<grid::Mosaic> mosaic = fail(ErrorCode::empty, "");
    for (const int threads : request.threads) {
        Least least;
        for (int run = 0; run < request.runs; ++run) {
            mosaic = fail(ErrorCode::empty, "");  // frees its memory for the next mosaic
            mosaic = run_once(nation, *bytes, **geometry, threads, least);
            if (!mosaic) return pass_on(mosaic);
        }
        table.add({{"case", "us"},
                   {"sites", static_cast<int>(nation.sites().size())},
                   {"threads", threads},
                   {"update_cpu", {least.update, 3}},
                   {"sum_cpu", {least.sum, 3}},
                   {"merge_cpu", {least.merge, 3}},
                   {"update_s", {least.update_s, 3}},
                   {"merge_s", {least.merge_s, 3}},
                   {"peak_mib", {static_cast<double>(high_water_kib()) / 1024, 0}}});
    }
    return cache ? commit(*mosaic, *cache) : Status{};
}

}  // namespace stormcellar::bench

#include "bench/merge_case.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using grid::GridSpec;
using grid::GridWindow;
using grid::SitePosition;

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

struct Least {
    double decode = HUGE_VAL, grid = HUGE_VAL, bricks = HUGE_VAL, update = HUGE_VAL;
    double sum = HUGE_VAL, merge = HUGE_VAL, update_s = HUGE_VAL, merge_s = HUGE_VAL;
};

// From bytes to bricks.
grid::BrickGrid bricks_of(const Newcomer& from, int threads, Least& least) {
    Result<level2::Volume> volume = fail(ErrorCode::empty, "");
    keep_least_cpu(least.decode, [&] { volume = decode_ref(from.bytes, from.station, threads); });
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

// Merges in stripes of whole bricks.
Result<grid::Mosaic> build(const MergeCase& merged, const grid::MosaicOptions& options) {
    const GridSpec& domain = merged.domain;
    if (merged.stripes == 1) {
        const auto partials = merged.partials_in({0, 0, domain.nx, domain.ny});
        if (!partials) return pass_on(partials);
        return grid::merge(domain, *partials, options);
    }
    auto mosaic = grid::merge(domain, {}, options);
    if (!mosaic) return mosaic;
    const int bricks = (grid::bricks_along(domain.nx) + merged.stripes - 1) / merged.stripes;
    const int width = bricks * grid::brick_edge;
    for (int x = 0; x < domain.nx; x += width) {
        const GridWindow stripe{x, 0, std::min(width, domain.nx - x), domain.ny};
        const auto partials = merged.partials_in(stripe);
        if (!partials) return pass_on(partials);
        const Status done = grid::update_in_place(*mosaic, *partials, {&stripe, 1}, options);
        if (!done) return pass_on(done);
    }
    return mosaic;
}

// Merges the new volume in place of the previous one of its site.
Status update(const MergeCase& merged, const grid::BrickView& bricks,
              const grid::MosaicOptions& options, grid::Mosaic& mosaic) {
    const Newcomer& newcomer = merged.newcomer;
    auto partials = merged.partials_in(newcomer.window);
    if (!partials) return pass_on(partials);
    for (grid::Partial& partial : *partials) {
        if (partial.site.icao == newcomer.site.icao) partial.view = bricks;
    }
    return grid::update_in_place(mosaic, *partials, {&newcomer.window, 1}, options);
}

struct Found {
    double mosaic_mib = 0, stored = 0;
};

Row row_of(const MergeCase& merged, int threads, const Least& least, const Found& found) {
    const int touched = grid::bricks_along(merged.newcomer.window.nx) *
                        grid::bricks_along(merged.newcomer.window.ny);
    const int columns = grid::bricks_along(merged.domain.nx) * grid::bricks_along(merged.domain.ny);
    return {{"case", merged.name},
            {"sites", merged.sites},
            {"overlap", grid::overlap_name(merged.overlap)},
            {"threads", threads},
            {"decode_cpu", {least.decode, 3}},
            {"grid_cpu", {least.grid, 3}},
            {"bricks_cpu", {least.bricks, 3}},
            {"update_cpu", {least.update, 3}},
            {"sum_cpu", {least.sum, 3}},
            {"merge_cpu", {least.merge, 3}},
            {"update_s", {least.update_s, 3}},
            {"merge_s", {least.merge_s, 3}},
            {"once_cpu", {merged.newcomer.once_cpu, 3}},
            {"touched", fmt::format("{}/{}", touched, columns)},
            {"stored", {found.stored, 3}},
            {"others_stored", {merged.others_stored, 3}},
            {"mosaic_mib", {found.mosaic_mib, 0}},
            {"peak_mib", {static_cast<double>(high_water_kib()) / 1024, 0}}};
}

}  // namespace

SitePosition position_of(const Station& station) {
    return {std::string(station.icao), station.latitude_deg, station.longitude_deg,
            station.antenna_altitude_m};
}

Newcomer prepare(const GridSpec& domain, const fs::path& file, std::string_view station,
                 const SitePosition& site) {
    Newcomer newcomer{*read_file(file), std::string(station), site, {}, nullptr, nullptr, 0};
    const double start_s = cpu_s();
    newcomer.window = *grid::site_window(domain, site);
    newcomer.geometry =
        grid::make_column_geometry(site, grid::window_spec(domain, newcomer.window)).value();
    newcomer.distance = std::make_shared<const grid::SiteDistance>(domain, newcomer.window, site);
    newcomer.once_cpu = cpu_s() - start_s;
    return newcomer;
}

double stored_part(const grid::BrickView& view) {
    const auto stored = std::count_if(
        view.bricks.begin(), view.bricks.end(),
        [](const grid::BrickEntry& entry) { return entry.kind == grid::BrickKind::stored; });
    return static_cast<double>(stored) / static_cast<double>(view.bricks.size());
}

grid::BrickGrid bricks_of(const Newcomer& from, int threads) {
    Least none;
    return bricks_of(from, threads, none);
}

Result<Row> measure_merge(const MergeCase& merged, int threads, int runs) {
    grid::MosaicOptions options;
    options.overlap = merged.overlap;
    options.threads = threads;
    Least least;
    Found found;
    for (int run = 0; run < runs; ++run) {
        Result<grid::Mosaic> mosaic = fail(ErrorCode::empty, "");
        least.merge_s =
            std::min(least.merge_s, seconds_of([&] {
                         keep_least_cpu(least.merge, [&] { mosaic = build(merged, options); });
                     }));
        if (!mosaic) return pass_on(mosaic);
        const double start_s = cpu_s();
        const grid::BrickGrid bricks = bricks_of(merged.newcomer, threads, least);
        Status updated;
        const auto work = [&] { updated = update(merged, bricks.view(), options, *mosaic); };
        least.update_s =
            std::min(least.update_s, seconds_of([&] { keep_least_cpu(least.update, work); }));
        if (!updated) return pass_on(updated);
        least.sum = std::min(least.sum, cpu_s() - start_s);
        found = {memory_mib(mosaic->cells.view()), stored_part(bricks.view())};
    }
    return row_of(merged, threads, least, found);
}

}  // namespace stormcellar::bench

#include "stormcellar/grid/grid.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "capi/guarded.h"
#include "capi/volume_handle.h"
#include "stormcellar/grid/gridder.h"

struct stormcellar_grid {
    stormcellar::grid::Grid grid;
    bool is_mean_of_cells = false;
};

namespace stormcellar::capi {
namespace {

static_assert(static_cast<int>(grid::CellStatus::not_seen) == STORMCELLAR_CELL_NOT_SEEN);
static_assert(static_cast<int>(grid::CellStatus::no_echo) == STORMCELLAR_CELL_NO_ECHO);
static_assert(static_cast<int>(grid::CellStatus::range_folded) == STORMCELLAR_CELL_RANGE_FOLDED);
static_assert(static_cast<int>(grid::CellStatus::value) == STORMCELLAR_CELL_VALUE);
static_assert(static_cast<int>(grid::CellStatus::ambiguous) == STORMCELLAR_CELL_AMBIGUOUS);
static_assert(sizeof(grid::CellStatus) == 1);

Result<grid::SitePosition> site_of(const level2::Volume& volume) {
    const auto antenna = level2::antenna_position(volume);
    if (!antenna)
        return fail(ErrorCode::not_found, "the position of the radar is unknown; name the station");
    return grid::SitePosition{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                              antenna->altitude_m};
}

Result<grid::GridSpec> spec_of(const stormcellar_grid_options& options,
                               const grid::SitePosition& site) {
    const bool is_elsewhere = options.has_center != 0;
    grid::GridSpec spec =
        grid::default_spec(is_elsewhere ? options.center_latitude_deg : site.latitude_deg,
                           is_elsewhere ? options.center_longitude_deg : site.longitude_deg);
    if (options.columns != 0) spec.nx = options.columns;
    if (options.rows != 0) spec.ny = options.rows;
    if (options.spacing_m != 0) spec.spacing_m = options.spacing_m;
    if (options.level_count < 0 || (options.level_count > 0 && options.levels_m == nullptr))
        return fail(ErrorCode::bad_argument, "level_count is {}, and levels_m is {}",
                    options.level_count, options.levels_m == nullptr ? "null" : "given");
    if (options.level_count > 0)
        spec.levels_m.assign(options.levels_m, options.levels_m + options.level_count);
    if (Status valid = grid::validate(spec); !valid) return pass_on(valid);
    return spec;
}

Result<grid::GridderOptions> gridder_of(const stormcellar_grid_options& options) {
    grid::GridderOptions gridder;
    if (options.moment != nullptr) {
        const auto moment = level2::moment_from_name(options.moment);
        if (!moment)
            return fail(ErrorCode::bad_argument, "there is no moment '{}'", options.moment);
        gridder.moment = *moment;
    }
    if (options.threads < 0) return fail(ErrorCode::bad_argument, "threads must be at least 0");
    gridder.threads = std::max(1, options.threads);
    if (options.interpolation != nullptr) {
        const auto row = std::ranges::find(grid::interpolation_facts, options.interpolation,
                                           &grid::InterpolationFacts::name);
        if (row == grid::interpolation_facts.end())
            return fail(ErrorCode::bad_argument,
                        "interpolation is '{}'; it must be nearest, linear, eight-point or "
                        "beam-weighted",
                        options.interpolation);
        gridder.method.interpolation = row->interpolation;
    }
    if (options.mean_of_cell != 0) gridder.method.cell = grid::CellExtent::area;
    if (options.average_in_z != 0) gridder.method.averaging = grid::Averaging::in_z;
    return gridder;
}

Status make(const stormcellar_volume* volume, const stormcellar_grid_options* options,
            stormcellar_grid** grid) {
    if (volume == nullptr || grid == nullptr) return is_null(volume == nullptr ? "volume" : "grid");
    *grid = nullptr;
    const auto all = take(options);
    if (!all) return pass_on(all);
    const auto site = site_of(volume->volume);
    if (!site) return pass_on(site);
    const auto spec = spec_of(*all, *site);
    if (!spec) return pass_on(spec);
    const auto gridder = gridder_of(*all);
    if (!gridder) return pass_on(gridder);
    const auto geometry = grid::make_column_geometry(*site, *spec);
    if (!geometry) return pass_on(geometry);
    auto made = grid::make_grid(volume->volume, *site, **geometry, *gridder);
    if (!made) return pass_on(made);
    *grid = new stormcellar_grid{std::move(*made), all->mean_of_cell != 0};
    return {};
}

Status describe_grid(const stormcellar_grid* grid, stormcellar_grid_facts* to) {
    if (grid == nullptr) return is_null("grid");
    const grid::Grid& made = grid->grid;
    stormcellar_grid_facts facts{};
    copy_text(level2::moment_name(made.moment), facts.moment, sizeof facts.moment);
    copy_text(level2::moment_units(made.moment), facts.unit, sizeof facts.unit);
    facts.columns = made.spec.nx;
    facts.rows = made.spec.ny;
    facts.levels = made.spec.nz();
    facts.mean_of_cell = grid->is_mean_of_cells ? 1 : 0;
    facts.spacing_m = made.spec.spacing_m;
    facts.center_latitude_deg = made.spec.center_latitude_deg;
    facts.center_longitude_deg = made.spec.center_longitude_deg;
    facts.time_ms = milliseconds_of(made.time);
    facts.start_ms = milliseconds_of(made.start_time);
    facts.end_ms = milliseconds_of(made.end_time);
    return give(facts, to);
}

// Points to an array of the grid.
template <class Value, class Array>
Status point(const stormcellar_grid* grid, const Value** to, Array array) {
    if (grid == nullptr || to == nullptr)
        return is_null(grid == nullptr ? "grid" : "the pointer to the array");
    *to = array(grid->grid);
    return {};
}

}  // namespace
}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_grid_make(const stormcellar_volume* volume,
                                       const stormcellar_grid_options* options,
                                       stormcellar_grid** grid, stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::make(volume, options, grid); });
}

void stormcellar_grid_free(stormcellar_grid* grid) {
    delete grid;
}

stormcellar_code stormcellar_grid_describe(const stormcellar_grid* grid,
                                           stormcellar_grid_facts* facts,
                                           stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::describe_grid(grid, facts); });
}

stormcellar_code stormcellar_grid_levels(const stormcellar_grid* grid, const double** levels_m,
                                         stormcellar_error* error) {
    return capi::guarded(error, [&] {
        return capi::point(grid, levels_m,
                           [](const grid::Grid& made) { return made.spec.levels_m.data(); });
    });
}

stormcellar_code stormcellar_grid_values(const stormcellar_grid* grid, const float** values,
                                         stormcellar_error* error) {
    return capi::guarded(error, [&] {
        return capi::point(grid, values, [](const grid::Grid& made) { return made.values.data(); });
    });
}

stormcellar_code stormcellar_grid_states(const stormcellar_grid* grid, const uint8_t** states,
                                         stormcellar_error* error) {
    return capi::guarded(error, [&] {
        return capi::point(grid, states, [](const grid::Grid& made) {
            return reinterpret_cast<const std::uint8_t*>(made.status.data());
        });
    });
}

#include "stormcellar/grid/grid.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "capi/grid_handle.h"
#include "capi/guarded.h"

namespace stormcellar::capi {
namespace {

static_assert(static_cast<int>(grid::CellStatus::not_seen) == STORMCELLAR_CELL_NOT_SEEN);
static_assert(static_cast<int>(grid::CellStatus::no_echo) == STORMCELLAR_CELL_NO_ECHO);
static_assert(static_cast<int>(grid::CellStatus::range_folded) == STORMCELLAR_CELL_RANGE_FOLDED);
static_assert(static_cast<int>(grid::CellStatus::value) == STORMCELLAR_CELL_VALUE);
static_assert(static_cast<int>(grid::CellStatus::ambiguous) == STORMCELLAR_CELL_AMBIGUOUS);
static_assert(sizeof(grid::CellStatus) == 1);

Status make(const stormcellar_volume* volume, const stormcellar_grid_options* options,
            stormcellar_grid** grid) {
    if (volume == nullptr || grid == nullptr) return is_null(volume == nullptr ? "volume" : "grid");
    *grid = nullptr;
    const auto all = take(options);
    if (!all) return pass_on(all);
    const auto gridding = gridding_of(*all, *volume);
    if (!gridding) return pass_on(gridding);
    const auto chain = chain_of(*all, gridding->gridder.moment, std::nullopt);
    if (!chain) return pass_on(chain);
    auto made = grid_of(*volume, gridding->site, gridding->spec, *chain, gridding->gridder);
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
    copy_text(grid::projection_name(made.spec.projection), facts.projection,
              sizeof facts.projection);
    facts.spacing_deg = made.spec.spacing_deg;
    std::ranges::copy(made.spec.parallels_deg, facts.parallels_deg);
    facts.offset_x_cells = made.spec.offset_x_cells;
    facts.offset_y_cells = made.spec.offset_y_cells;
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

// tests/export/grid_of_all_states.h -- makes a grid whose cells have each state by turns.
#pragma once

#include <chrono>
#include <utility>
#include <vector>

#include "stormcellar/grid/grid.h"

namespace stormcellar::testing {

// Returns the grid. Each cell that has a value has a quarter of its own number as the value.
inline grid::Grid grid_of_all_states(level2::Moment moment, int columns, int rows,
                                     std::vector<double> levels_m) {
    grid::Grid grid;
    grid.moment = moment;
    grid.spec = grid::default_spec(35, -97);
    grid.spec.nx = columns;
    grid.spec.ny = rows;
    grid.spec.levels_m = std::move(levels_m);
    grid.time = grid.start_time = grid.end_time = UtcTime{std::chrono::seconds{1'600'000'000}};
    grid.sites = {{"KTLX", 35, -97, 389}};
    grid.provenance.stations = {"KTLX"};
    grid.provenance.method = "column-linear";
    grid.provenance.predicted_error = "0.4 dBZ";
    grid.values.resize(grid.spec.cell_count());
    grid.status.resize(grid.spec.cell_count());
    for (std::size_t cell = 0; cell < grid.values.size(); ++cell) {
        grid.status[cell] = static_cast<grid::CellStatus>(cell % 4);
        if (grid.status[cell] == grid::CellStatus::value)
            grid.values[cell] = 0.25F * static_cast<float>(cell);
    }
    return grid;
}

}  // namespace stormcellar::testing

// bench_cells: finds the storm cells of real volumes, and prints their number and the time.
//
// usage: bench_cells [--data DIR] [--runs N] [--json] [FILE ...]   (bench/request.h)
// Each volume is gridded as usual (grid::default_spec). Prints a row for each file:
//   file       name of the file
//   strong     number of grid cells of at least 35 dBZ
//   cells      number of storm cells
//   max_dbz    largest reflectivity of a cell
//   cells_ms   CPU time of one thread to find the cells with hail, the least of the runs
//   motion_ms  CPU time of the motion of the echo, from the volume to itself
#include <filesystem>
#include <utility>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "retrieve/cells/strong_echo.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::bench {
namespace {

// Returns the grid of a volume. Errors: those of reading and gridding.
Result<grid::BrickGrid> gridded_volume(const std::filesystem::path& file) {
    const auto volume = decode_ref(file, 1);
    if (!volume) return pass_on(volume);
    const auto site = site_of(*volume);
    if (!site) return pass_on(site);
    const auto columns = grid::make_column_geometry(
        *site, grid::default_spec(site->latitude_deg, site->longitude_deg));
    if (!columns) return pass_on(columns);
    const auto made = grid::make_grid(*volume, *site, **columns, {});
    if (!made) return pass_on(made);
    return grid::BrickGrid::from(*made, grid::default_quantization(level2::Moment::ref));
}

void measure_cells(const std::filesystem::path& file, const Request& request, Table& table) {
    const auto bricks = gridded_volume(file);
    if (!bricks) {
        fmt::print(stderr, "bench_cells: left out: {}\n", bricks.error().message);
        return;
    }
    const grid::BrickView view = bricks->view();
    const retrieve::CellFields fields{view, {}, retrieve::FreezingLevels{}};
    Result<retrieve::CellScan> found;
    const double cells_ms =
        least_cpu_ms(request.runs, [&] { found = retrieve::find_cells(fields, {}, ""); });
    retrieve::CellScan scan = found.value();
    const double motion_ms =
        least_cpu_ms(request.runs, [&] { (void)retrieve::guess_motions(scan, view, view, 300); });
    const retrieve::StrongEcho echo(view, retrieve::CellOptions{}.least_dbz);
    const double max_dbz =
        scan.cells.empty() ? 0.0 : static_cast<double>(scan.cells.front().max_dbz);
    table.add({{"file", file.filename().string()},
               {"strong", static_cast<int>(echo.cells().size())},
               {"cells", static_cast<int>(scan.cells.size())},
               {"max_dbz", Cell(max_dbz, 1)},
               {"cells_ms", Cell(cells_ms, 2)},
               {"motion_ms", Cell(motion_ms, 2)}});
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    using namespace stormcellar::bench;
    return run_over_files({"bench_cells", "[FILE ...]", "finds the storm cells of real volumes"},
                          {argv, static_cast<std::size_t>(argc)}, measure_cells);
}

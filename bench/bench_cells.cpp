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
#include <ctime>
#include <filesystem>
#include <limits>
#include <stdexcept>
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

template <class Value>
Value taken(Result<Value> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

template <class Work>
double least_cpu_ms(int runs, const Work& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < runs; ++i) {
        const std::clock_t start = std::clock();
        work();
        least = std::min(least, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return least;
}

void measure_cells(const std::filesystem::path& file, const Request& request, Table& table) {
    const auto volume = taken(decode_ref(file, 1));
    const auto site = taken(site_of(volume));
    const auto columns = taken(grid::make_column_geometry(
        site, grid::default_spec(site.latitude_deg, site.longitude_deg)));
    const grid::BrickGrid bricks =
        grid::BrickGrid::from(taken(grid::make_grid(volume, site, *columns, {})),
                              grid::default_quantization(level2::Moment::ref));
    const grid::BrickView view = bricks.view();
    const retrieve::CellFields fields{view, {}, retrieve::FreezingLevels{}};
    retrieve::CellScan scan;
    const double cells_ms = least_cpu_ms(
        request.runs, [&] { scan = taken(retrieve::find_cells(fields, {}, site.icao)); });
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

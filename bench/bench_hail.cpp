// bench_hail: measures the time of maps of hail of real volumes, or prints the hail of profiles.
//
// usage: bench_hail [--data DIR] [--runs N] [--json] [FILE ...]   (bench/request.h)
//        bench_hail --profiles < FILE
// Each volume is gridded as usual (grid::default_spec), on one thread. The levels of 0 and -20 C
// are at the usual heights (retrieve/hail.h). Prints a row for each file:
//   file         name of the file
//   columns      number of columns with hail
//   mesh_mm      largest MESH, and its range if the levels err by 300 m (least_mm, most_mm)
//   map_ms       CPU time of the map, without the summaries of columns, the least of the runs
//   columns_ms   CPU time of the summaries of columns, which all maps of a grid share
//   range_ms     CPU time to find the largest MESH and its range
// With --profiles, each line of the standard input is a column: the heights of 0 and -20 C and of
// the radar in meters, then pairs of height and dBZ from the lowest up; nan is a missing value.
// Prints SHI, POSH, MESH, MESH75 and MESH95 of each column in a line. bench/compare_hail.py uses
// this.
#include <algorithm>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "render/products/hail_field.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::bench {
namespace {

using retrieve::FreezingLevels;

template <class Value>
Value needed(Result<Value> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

grid::BrickGrid gridded(const std::filesystem::path& file) {
    const auto volume = needed(decode_ref(file, 1));
    const auto site = needed(site_of(volume));
    const auto columns = needed(grid::make_column_geometry(
        site, grid::default_spec(site.latitude_deg, site.longitude_deg)));
    return grid::BrickGrid::from(needed(grid::make_grid(volume, site, *columns, {})),
                                 grid::default_quantization(level2::Moment::ref));
}

void measure(const std::filesystem::path& file, const Request& request, Table& table) {
    const grid::BrickGrid bricks = gridded(file);
    const grid::BrickView view = bricks.view();
    const FreezingLevels levels;
    std::vector<render::ColumnSummary> columns;
    render::FlatField map;
    std::optional<render::LargestHail> largest;
    const double columns_ms =
        least_cpu_ms(request.runs, [&] { columns = render::summarize_columns(view, 1); });
    const double map_ms = least_cpu_ms(request.runs, [&] {
        map = needed(render::hail_field(view, &retrieve::Hail::mesh_mm, levels, 0, columns, 1));
    });
    const double range_ms = least_cpu_ms(
        request.runs, [&] { largest = needed(render::largest_hail(view, levels, 1)); });
    const auto with_hail = std::ranges::count(map.status, grid::CellStatus::value);
    const render::LargestHail none;
    const render::LargestHail& shown = largest ? *largest : none;
    table.add({{"file", file.filename().string()},
               {"columns", static_cast<int>(with_hail)},
               {"mesh_mm", Cell(static_cast<double>(shown.mesh_mm), 1)},
               {"least_mm", Cell(static_cast<double>(shown.range.least_mm), 1)},
               {"most_mm", Cell(static_cast<double>(shown.range.most_mm), 1)},
               {"map_ms", Cell(map_ms, 2)},
               {"columns_ms", Cell(columns_ms, 2)},
               {"range_ms", Cell(range_ms, 2)}});
}

Result<std::string> hail_text(const std::string& line) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; words >> word;)
        numbers.push_back(std::strtod(word.c_str(), nullptr));
    if (numbers.size() < 5 || numbers.size() % 2 == 0)
        return fail(ErrorCode::bad_argument, "a line has three heights and pairs of numbers");
    std::vector<double> heights_m;
    std::vector<float> dbz;
    for (std::size_t i = 3; i < numbers.size(); i += 2) {
        heights_m.push_back(numbers[i]);
        dbz.push_back(static_cast<float>(numbers[i + 1]));
    }
    const auto layers = retrieve::hail_layers(heights_m, {numbers[0], numbers[1]}, numbers[2]);
    if (!layers) return pass_on(layers);
    const retrieve::Hail hail = retrieve::hail_of_column(*layers, dbz);
    return fmt::format("{} {} {} {} {}\n", hail.shi_j_per_m_s, hail.posh_percent, hail.mesh_mm,
                       hail.mesh75_mm, hail.mesh95_mm);
}

Status print_profiles() {
    for (std::string line; std::getline(std::cin, line);) {
        const auto text = hail_text(line);
        if (!text) return pass_on(text);
        std::cout << *text;
    }
    return {};
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    using namespace stormcellar::bench;
    const std::span<char* const> all{argv, static_cast<std::size_t>(argc)};
    if (all.size() == 2 && std::string_view(all[1]) == "--profiles")
        return exit_status("bench_hail", print_profiles());
    return run_over_files({"bench_hail", "[FILE ...]", "measures maps of hail of real volumes"},
                          all, measure);
}

// bench_merge: measures what a mosaic costs, and an update of it with one site's new volume.
//
// usage: bench_merge [--data DIR] [--threads N] [--runs N] [--json]      (bench/request.h)
// The neighboring sites of DIR/mosaic-northeast are merged on one grid of 1 km and 32 levels.
// (bench_mosaic has the same row for 160 sites on the grid of the United States.) A row:
//   case        northeast
//   sites       number of partials
//   overlap     the rule
//   threads     for all phases
//   decode_cpu, grid_cpu, bricks_cpu  the new volume: decoded (REF alone), gridded on its window
//                                     with the geometry kept, and converted to bricks
//   update_cpu  merging its partial into the mosaic, in place: the bricks of its window
//   sum_cpu     the sum: seconds of CPU time of all threads, least of the runs
//   merge_cpu   merging the mosaic anew from all partials
//   update_s, merge_s  wall-clock seconds of both
//   once_cpu    what is kept for a site: azimuths and arcs of its window, and distances
//   touched     columns of bricks that the update merged, and the number of all
//   stored      share of the updated site's bricks that hold values
//   others_stored  the same for all partials, on average
//   mosaic_mib  memory of the mosaic's written pages, table and states
//   peak_mib    peak memory of the process so far, all partials included
#include <algorithm>
#include <deque>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "bench/merge_case.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

grid::GridSpec northeast_grid() {
    grid::GridSpec spec = grid::default_spec(41.5, -75);
    spec.nx = 1280;
    spec.ny = 1280;
    return spec;
}

void measure_northeast(const fs::path& data, const Request& request, Table& table) {
    const grid::GridSpec domain = northeast_grid();
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
        newcomers.push_back(prepare(domain, file, station->icao, position_of(*station)));
        grids.push_back(bricks_of(newcomers.back(), 2));
        partials.push_back({grids.back().view(), newcomers.back().site, newcomers.back().distance});
        if (partials.size() < 2) continue;
        const bool last = file == files.back();
        double stored = 0;
        for (const grid::Partial& partial : partials)
            stored += stored_part(partial.view);
        MergeCase merged{"northeast", domain, static_cast<int>(partials.size()),
                         [&](const grid::GridWindow&) { return partials; }, newcomers.front()};
        merged.others_stored = stored / static_cast<double>(partials.size());
        for (const grid::Overlap overlap : {grid::Overlap::distance_weighted, grid::Overlap::mean,
                                            grid::Overlap::maximum, grid::Overlap::nearest}) {
            if (!last && overlap != grid::Overlap::distance_weighted) continue;
            merged.overlap = overlap;
            for (const int threads : request.threads) {
                auto row = measure_merge(merged, threads, request.runs);
                if (row) table.add(std::move(*row));
            }
        }
    }
}

int run(int argc, char** argv) {
    keep_freed_memory();
    const auto [request, usage_status] =
        read_request({"bench_merge", "", "what a mosaic of neighbouring sites costs"},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    Table table(request->json);
    measure_northeast(request->data_directory(), *request, table);
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}

// bench/merge_case.h -- what a mosaic costs, and bringing it up to date with one site's new volume.
//
// Threads: pure functions but for clocks of the whole process; measure from one thread at a time.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/station_table.h"
#include "bench/measure.h"
#include "bench/table.h"
#include "grid/brick_grid.h"
#include "grid/gridder.h"
#include "grid/mosaic.h"

namespace stormcellar::bench {

[[nodiscard]] grid::SitePosition position_of(const Station& station);

// A site's new volume, and what is kept for its site.
struct Newcomer {
    Bytes bytes;
    std::string station;  // that the file is of
    grid::SitePosition site;
    grid::GridWindow window;
    std::shared_ptr<const grid::ColumnGeometry> geometry;
    std::shared_ptr<const grid::SiteDistance> distance;
    double once_cpu = 0;
};
// The file must be there, and the site reach the domain.
[[nodiscard]] Newcomer prepare(const grid::GridSpec& domain, const std::filesystem::path& file,
                               std::string_view station, const grid::SitePosition& site);
// The volume's partial, from bytes to bricks.
[[nodiscard]] grid::BrickGrid bricks_of(const Newcomer& from, int threads);

struct MergeCase {
    std::string name;
    const grid::GridSpec& domain;
    std::vector<grid::Partial> partials;  // the newcomer's site has one of its own
    const Newcomer& newcomer;
    grid::Overlap overlap = grid::Overlap::distance_weighted;
};
// A row: the columns of bench_merge.
[[nodiscard]] Row measure_merge(const MergeCase& merged, int threads, int runs);

}  // namespace stormcellar::bench

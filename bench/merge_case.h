// bench/merge_case.h -- measures what a mosaic costs, and an update with one site's new volume.
//
// Threads   One thread at a time, because the clocks are those of the whole process.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure.h"
#include "bench/table.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::bench {

[[nodiscard]] grid::SitePosition position_of(const Station& station);

// A new volume of a site, and what is kept for the site.
struct Newcomer {
    Bytes bytes;
    std::string station;  // the station of the file
    grid::SitePosition site;
    grid::GridWindow window;
    std::shared_ptr<const grid::ColumnGeometry> geometry;
    std::shared_ptr<const grid::SiteDistance> distance;
    double once_cpu = 0;
};
// The file must exist, and the site must reach the domain.
[[nodiscard]] Newcomer prepare(const grid::GridSpec& domain, const std::filesystem::path& file,
                               std::string_view station, const grid::SitePosition& site);
// Makes the partial of the volume, from bytes to bricks.
[[nodiscard]] grid::BrickGrid bricks_of(const Newcomer& from, int threads);

// Returns the share of a partial's bricks that hold values.
[[nodiscard]] double stored_part(const grid::BrickView& view);

struct MergeCase {
    std::string name;
    const grid::GridSpec& domain;
    int sites = 0;
    // Returns the partials whose windows touch this one, including that of the new volume's site.
    // Valid until the next call.
    std::function<Result<std::vector<grid::Partial>>(const grid::GridWindow&)> partials_in;
    const Newcomer& newcomer;
    grid::Overlap overlap = grid::Overlap::distance_weighted;
    int stripes = 1;           // stripes in which the whole mosaic is made, west to east
    double others_stored = 0;  // mean of stored_part() over all partials
};
// Returns a row with the columns of bench_merge. Errors: those of partials_in and of merging.
[[nodiscard]] Result<Row> measure_merge(const MergeCase& merged, int threads, int runs);

}  // namespace stormcellar::bench

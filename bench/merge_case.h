// bench/merge_case.h -- what a mosaic costs, and bringing it up to date with one site's new volume.
//
// Threads: pure functions but for clocks of the whole process; measure from one thread at a time.
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

// The part of a partial's bricks that hold values.
[[nodiscard]] double stored_part(const grid::BrickView& view);

struct MergeCase {
    std::string name;
    const grid::GridSpec& domain;
    int sites = 0;
    // Those whose windows touch this one, the newcomer's site's among them; valid until the next
    // call.
    std::function<Result<std::vector<grid::Partial>>(const grid::GridWindow&)> partials_in;
    const Newcomer& newcomer;
    grid::Overlap overlap = grid::Overlap::distance_weighted;
    int stripes = 1;           // in which the whole mosaic is made, west to east
    double others_stored = 0;  // mean of stored_part() of all partials
};
// A row: the columns of bench_merge. Errors: those of partials_in and merging.
[[nodiscard]] Result<Row> measure_merge(const MergeCase& merged, int threads, int runs);

}  // namespace stormcellar::bench

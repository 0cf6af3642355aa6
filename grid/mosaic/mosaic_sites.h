// grid/mosaic/mosaic_sites.h -- checks the partials of a mosaic (grids of single sites) and sorts
// them into the order in which they are summed.
//
// Threads   Plain values and functions.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "grid/beam/detection_limit.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

// A partial, and its position in the domain.
struct PlacedSite {
    const Partial* partial = nullptr;
    GridWindow window;
    std::shared_ptr<const SiteDistance> distance;
    DetectionLimit limit;

    [[nodiscard]] bool covers(int bx, int by) const {
        const int x = bx * brick_edge;
        const int y = by * brick_edge;
        return window.first_x <= x && x < window.end_x() && window.first_y <= y &&
               y < window.end_y();
    }
    [[nodiscard]] std::size_t brick(int bx, int by, int bz) const {
        return partial->view.brick_index(bx - window.first_x / brick_edge,
                                         by - window.first_y / brick_edge, bz);
    }
};

[[nodiscard]] bool has_shape_of(const BrickView& view, const GridSpec& spec);

// Checks the partials and returns them sorted by ICAO, then position. Errors: bad_argument, as in
// merge().
[[nodiscard]] Result<std::vector<PlacedSite>> place_sites(const GridSpec& domain,
                                                          std::span<const Partial> partials,
                                                          const Quantization& quantization);

// Computes the distances for sites that lack them.
void measure_distances(const GridSpec& domain, int threads, std::vector<PlacedSite>& sites);

}  // namespace stormcellar::grid

// grid/mosaic/mosaic_sites.h -- checks the partials of a mosaic and puts them in the order of their
// sums.
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

// A partial and its place in the domain.
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

// Sorts by ICAO, then position, whatever order the partials came in. Errors: bad_argument, as
// merge() says.
[[nodiscard]] Result<std::vector<PlacedSite>> place_sites(const GridSpec& domain,
                                                          std::span<const Partial> partials,
                                                          const Quantization& quantization);

// Computes the distances that are missing.
void measure_distances(const GridSpec& domain, int threads, std::vector<PlacedSite>& sites);

}  // namespace stormcellar::grid

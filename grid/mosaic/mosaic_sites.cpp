#include "grid/mosaic/mosaic_sites.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "grid/place/site_extent.h"
#include "grid/sweep/sweep_stack.h"

namespace stormcellar::grid {
namespace {

bool is_usable(const Quantization& quantization) {
    return (quantization.code_bytes == 1 || quantization.code_bytes == 2) &&
           std::isfinite(quantization.first_value) && std::isfinite(quantization.step) &&
           quantization.step > 0;
}

Result<PlacedSite> place(const GridSpec& domain, const Partial& partial,
                         const Quantization& quantization) {
    const SitePosition& site = partial.site;
    if (Status good = check_on_earth(site); !good) return pass_on(good);
    const BrickView& view = partial.view;
    const auto window = view.spec == nullptr ? std::nullopt : window_of(domain, *view.spec);
    if (!window || !is_whole_bricks(domain, *window) || !has_shape_of(view, *view.spec)) {
        return fail(ErrorCode::bad_argument,
                    "the grid of {} is not a window of whole bricks of the domain", site.icao);
    }
    if (!(view.quantization == quantization) || !is_usable(quantization)) {
        return fail(ErrorCode::bad_argument, "the grid of {} is not quantized like the others",
                    site.icao);
    }
    PlacedSite placed{&partial, *window, partial.distance, {}};
    if (is_tdwr(site.icao)) placed.limit.at_1km_dbz = tdwr_limit_at_1km_dbz;
    if (placed.distance == nullptr) return placed;
    const GridWindow& made = placed.distance->window();
    const bool fits = placed.distance->is_of(site) && made.first_x <= window->first_x &&
                      made.first_y <= window->first_y && made.end_x() >= window->end_x() &&
                      made.end_y() >= window->end_y();
    if (!fits) {
        return fail(ErrorCode::bad_argument, "the distances for {} are those of another place",
                    site.icao);
    }
    return placed;
}

}  // namespace

bool has_shape_of(const BrickView& view, const GridSpec& spec) {
    const std::size_t bricks =
        static_cast<std::size_t>(view.bricks_x) * view.bricks_y * view.bricks_z;
    return view.bricks_x == bricks_along(spec.nx) && view.bricks_y == bricks_along(spec.ny) &&
           view.bricks_z == bricks_along(spec.nz()) && view.bricks.size() == bricks &&
           view.codes.size() ==
               bricks * brick_cells * static_cast<std::size_t>(view.quantization.code_bytes);
}

Result<std::vector<PlacedSite>> place_sites(const GridSpec& domain,
                                            std::span<const Partial> partials,
                                            const Quantization& quantization) {
    std::vector<PlacedSite> sites;
    for (const Partial& partial : partials) {
        auto placed = place(domain, partial, quantization);
        if (!placed) return pass_on(placed);
        sites.push_back(*std::move(placed));
    }
    const auto key = [](const PlacedSite& site) {
        const SitePosition& at = site.partial->site;
        return std::tie(at.icao, at.latitude_deg, at.longitude_deg, at.altitude_m);
    };
    std::sort(sites.begin(), sites.end(),
              [&](const PlacedSite& a, const PlacedSite& b) { return key(a) < key(b); });
    const auto twice = std::adjacent_find(
        sites.begin(), sites.end(),
        [&](const PlacedSite& a, const PlacedSite& b) { return key(a) == key(b); });
    if (twice != sites.end()) {
        return fail(ErrorCode::bad_argument, "the site {} is given twice",
                    twice->partial->site.icao);
    }
    return sites;
}

void measure_distances(const GridSpec& domain, int threads, std::vector<PlacedSite>& sites) {
    for_each_piece(static_cast<int>(sites.size()), threads, [&](int i) {
        PlacedSite& site = sites[static_cast<std::size_t>(i)];
        if (site.distance != nullptr) return;
        site.distance =
            std::make_shared<const SiteDistance>(domain, site.window, site.partial->site);
    });
}

}  // namespace stormcellar::grid

#include "stormcellar/grid/mosaic.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/floating_point.h"
#include "base/name_list.h"
#include "grid/cells/moment_rules.h"
#include "grid/mosaic/brick_merge.h"
#include "grid/mosaic/mosaic_fill.h"
#include "grid/mosaic/mosaic_sites.h"

namespace stormcellar::grid {
namespace {

static_assert(is_in_order(overlap_facts, &OverlapFacts::overlap));

constexpr double least_length_m = 1000;
constexpr double largest_length_m = 1e7;

Status check_options(const MosaicOptions& options) {
    const std::string_view why_apart = rules_of(options.moment).why_sites_stay_apart;
    const Overlap usual = default_overlap(options.moment);
    if (!why_apart.empty() && options.overlap != Overlap::nearest && options.overlap != usual) {
        return fail(ErrorCode::bad_argument,
                    "{} of different sites cannot be mixed ({}); use the overlap rule {}, not {}",
                    level2::moment_name(options.moment), why_apart, overlap_name(usual),
                    overlap_name(options.overlap));
    }
    if (options.averaging == Averaging::in_z && options.moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument, "only reflectivity can be averaged in Z, not {}",
                    level2::moment_name(options.moment));
    }
    if (!is_within(options.length_m, least_length_m, largest_length_m)) {
        return fail(ErrorCode::bad_argument, "the length of the weights must be {} to {} m, not {}",
                    least_length_m, largest_length_m, options.length_m);
    }
    if (options.threads < 1) {
        return fail(ErrorCode::bad_argument, "threads must be at least 1, not {}", options.threads);
    }
    return {};
}

Mosaic empty_mosaic(const GridSpec& domain, const Quantization& quantization,
                    const MosaicOptions& options) {
    Mosaic made{BrickGrid(domain, quantization), std::nullopt, std::nullopt};
    if (options.counts) made.counts.emplace(domain, count_quantization);
    if (options.weights) made.weights.emplace(domain, weight_quantization);
    return made;
}

Status check_previous(const MosaicView& previous, const MosaicOptions& options) {
    const auto fits = [&](const BrickView& view, const Quantization& quantization) {
        return view.spec != nullptr && *view.spec == *previous.cells.spec &&
               view.quantization == quantization && has_shape_of(view, *view.spec);
    };
    const bool good =
        previous.cells.spec != nullptr && fits(previous.cells, previous.cells.quantization) &&
        (!options.counts || (previous.counts && fits(*previous.counts, count_quantization))) &&
        (!options.weights || (previous.weights && fits(*previous.weights, weight_quantization)));
    if (good) return {};
    return fail(ErrorCode::bad_argument,
                "the mosaic to update is not complete, or has no counts or weights");
}

std::vector<bool> changed_columns(const BrickView& shape, std::span<const GridWindow> windows) {
    const auto rows = static_cast<std::size_t>(shape.bricks_y);
    std::vector<bool> changed(static_cast<std::size_t>(shape.bricks_x) * rows);
    for (const GridWindow& window : windows) {
        const int end_x = std::min(shape.bricks_x, bricks_along(window.end_x()));
        const int end_y = std::min(shape.bricks_y, bricks_along(window.end_y()));
        for (int bx = std::max(0, window.first_x / brick_edge); bx < end_x; ++bx) {
            for (int by = std::max(0, window.first_y / brick_edge); by < end_y; ++by)
                changed[static_cast<std::size_t>(bx) * rows + static_cast<std::size_t>(by)] = true;
        }
    }
    return changed;
}

// Removes sites whose windows touch no changed brick.
void drop_untouched(const BrickView& shape, const std::vector<bool>& changed,
                    std::vector<PlacedSite>& sites) {
    std::erase_if(sites, [&](const PlacedSite& site) {
        for (int bx = site.window.first_x / brick_edge; bx < bricks_along(site.window.end_x());
             ++bx) {
            for (int by = site.window.first_y / brick_edge; by < bricks_along(site.window.end_y());
                 ++by) {
                if (changed[static_cast<std::size_t>(bx) *
                                static_cast<std::size_t>(shape.bricks_y) +
                            static_cast<std::size_t>(by)]) {
                    return false;
                }
            }
        }
        return true;
    });
}

// The input of an update: the columns of bricks that changed, and the sites whose windows touch
// them.
struct ChangedPart {
    std::vector<bool> columns;
    std::vector<PlacedSite> sites;
};
Result<ChangedPart> changed_part(const MosaicView& previous, std::span<const Partial> partials,
                                 std::span<const GridWindow> changed,
                                 const MosaicOptions& options) {
    if (Status good = check_options(options); !good) return pass_on(good);
    if (Status good = check_previous(previous, options); !good) return pass_on(good);
    const GridSpec& domain = *previous.cells.spec;
    auto sites = place_sites(domain, partials, previous.cells.quantization);
    if (!sites) return pass_on(sites);
    std::vector<bool> columns = changed_columns(previous.cells, changed);
    drop_untouched(previous.cells, columns, *sites);
    measure_distances(domain, options.threads, *sites);
    return ChangedPart{std::move(columns), std::move(*sites)};
}

}  // namespace

std::string_view overlap_name(Overlap overlap) {
    return overlap_facts[static_cast<std::size_t>(overlap)].name;
}

std::optional<Overlap> overlap_from_name(std::string_view name) {
    return key_named(overlap_facts, &OverlapFacts::overlap, name);
}

Overlap default_overlap(level2::Moment moment) {
    const bool mixes = rules_of(moment).why_sites_stay_apart.empty();
    if (rules_of(moment).takes_largest_of_sites) return Overlap::maximum;
    return mixes ? Overlap::distance_weighted : Overlap::nearest;
}

MosaicView Mosaic::view() const {
    MosaicView view{cells.view(), std::nullopt, std::nullopt};
    if (counts) view.counts = counts->view();
    if (weights) view.weights = weights->view();
    return view;
}

Result<Mosaic> merge(const GridSpec& domain, std::span<const Partial> partials,
                     const MosaicOptions& options) {
    if (Status good = validate(domain); !good) return pass_on(good);
    if (Status good = check_options(options); !good) return pass_on(good);
    const Quantization quantization = partials.empty() ? default_quantization(options.moment)
                                                       : partials.front().view.quantization;
    auto sites = place_sites(domain, partials, quantization);
    if (!sites) return pass_on(sites);
    measure_distances(domain, options.threads, *sites);
    Mosaic made = empty_mosaic(domain, quantization, options);
    fill_mosaic({domain, options, *sites, nullptr, {}, made});
    return made;
}

Result<Mosaic> update(const MosaicView& previous, std::span<const Partial> partials,
                      std::span<const GridWindow> changed, const MosaicOptions& options) {
    auto work = changed_part(previous, partials, changed, options);
    if (!work) return pass_on(work);
    const GridSpec& domain = *previous.cells.spec;
    Mosaic made = empty_mosaic(domain, previous.cells.quantization, options);
    fill_mosaic({domain, options, work->sites, &previous, std::move(work->columns), made});
    return made;
}

Status update_in_place(Mosaic& mosaic, std::span<const Partial> partials,
                       std::span<const GridWindow> changed, const MosaicOptions& options) {
    const MosaicView view = mosaic.view();
    auto work = changed_part(view, partials, changed, options);
    if (!work) return pass_on(work);
    refill_mosaic(
        {*view.cells.spec, options, work->sites, nullptr, std::move(work->columns), mosaic});
    return {};
}

}  // namespace stormcellar::grid

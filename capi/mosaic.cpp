#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "capi/grid_handle.h"
#include "capi/guarded.h"
#include "pipeline/plan/mosaic_of_volumes.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::capi {
namespace {

// Returns the objects as a span. Errors: bad_argument if there is no object, or if an object is
// null.
template <class Object>
Result<std::span<const Object* const>> all_of(const Object* const* objects, std::size_t count,
                                              std::string_view name) {
    if (count == 0) return fail(ErrorCode::bad_argument, "there are no {}s", name);
    if (objects == nullptr) return is_null(fmt::format("{}s", name));
    const std::span all{objects, count};
    if (std::ranges::find(all, nullptr) != all.end()) return is_null(fmt::format("a {}", name));
    return all;
}

// Returns the rule of mixing for a moment.
Result<grid::MosaicOptions> rule_of(const stormcellar_mosaic_options* options,
                                    level2::Moment moment) {
    const auto all = take(options);
    if (!all) return pass_on(all);
    grid::MosaicOptions rule;
    rule.moment = moment;
    rule.overlap = grid::default_overlap(moment);
    if (all->length_m != 0) rule.length_m = all->length_m;
    if (all->overlap == nullptr) return rule;
    const auto overlap = grid::overlap_from_name(all->overlap);
    if (!overlap) {
        return fail(ErrorCode::bad_argument,
                    "overlap is '{}'; it must be mean, maximum, nearest or distance-weighted",
                    all->overlap);
    }
    rule.overlap = *overlap;
    return rule;
}

// Adds the texts that are not there yet.
void add_texts(const std::vector<std::string>& more, std::vector<std::string>& texts) {
    for (const std::string& text : more)
        if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
}

// Describes the merged cells: times and origins of all grids, and the method of the first.
void describe_merged(std::span<const stormcellar_grid* const> grids, grid::Overlap overlap,
                     grid::Grid& merged) {
    const grid::Grid& first = grids.front()->grid;
    merged.moment = first.moment;
    merged.time = first.time;
    merged.start_time = first.start_time;
    merged.end_time = first.end_time;
    merged.provenance = first.provenance;
    grid::Provenance& to = merged.provenance;
    to.effects += fmt::format(", overlap: {}", grid::overlap_name(overlap));
    to.vcp = 0;
    to.sweeps.clear();
    to.predicted_error.clear();
    for (const stormcellar_grid* one : grids) {
        const grid::Grid& grid = one->grid;
        const grid::Provenance& from = grid.provenance;
        merged.time = std::max(merged.time, grid.time);
        merged.start_time = std::min(merged.start_time, grid.start_time);
        merged.end_time = std::max(merged.end_time, grid.end_time);
        merged.sites.insert(merged.sites.end(), grid.sites.begin(), grid.sites.end());
        to.partial = to.partial || from.partial;
        add_texts(from.source_files, to.source_files);
        add_texts(from.stations, to.stations);
        add_texts(from.notes, to.notes);
        add_texts(from.radar_troubles, to.radar_troubles);
    }
}

Status check_partial(const stormcellar_grid& grid, const stormcellar_grid& first) {
    if (grid.grid.sites.size() != 1)
        return fail(ErrorCode::bad_argument, "a grid of {} radars cannot be merged again",
                    grid.grid.sites.size());
    if (grid.grid.moment != first.grid.moment)
        return fail(ErrorCode::bad_argument, "grids of {} and {} cannot be merged",
                    level2::moment_name(first.grid.moment), level2::moment_name(grid.grid.moment));
    if (grid.grid.spec == first.grid.spec) return {};
    return fail(ErrorCode::bad_argument,
                "the grids have different cells; give all of them the same center, size and "
                "levels");
}

Status merge(const stormcellar_grid* const* grids, std::size_t count,
             const stormcellar_mosaic_options* options, stormcellar_grid** merged) {
    if (merged == nullptr) return is_null("merged");
    *merged = nullptr;
    const auto all = all_of(grids, count, "grid");
    if (!all) return pass_on(all);
    const stormcellar_grid& first = *all->front();
    auto rule = rule_of(options, first.grid.moment);
    if (!rule) return pass_on(rule);
    if (first.grid.provenance.averaging == "Z") rule->averaging = grid::Averaging::in_z;
    std::vector<grid::BrickGrid> bricks;
    bricks.reserve(count);
    std::vector<grid::Partial> partials;
    for (const stormcellar_grid* one : *all) {
        if (Status fits = check_partial(*one, first); !fits) return fits;
        bricks.push_back(
            grid::BrickGrid::from(one->grid, grid::default_quantization(rule->moment)));
        partials.push_back({bricks.back().view(), one->grid.sites.front()});
    }
    const auto mosaic = grid::merge(first.grid.spec, partials, *rule);
    if (!mosaic) return pass_on(mosaic);
    auto made = grid::to_dense(mosaic->view().cells);
    describe_merged(*all, rule->overlap, made);
    *merged = new stormcellar_grid{std::move(made), first.is_mean_of_cells};
    return {};
}

// Returns the sites of the volumes, each once.
std::vector<grid::SitePosition> sites_of(const std::vector<pipeline::SceneVolume>& volumes) {
    std::vector<grid::SitePosition> sites;
    for (const pipeline::SceneVolume& volume : volumes) {
        if (std::ranges::find(sites, volume.site.icao, &grid::SitePosition::icao) == sites.end())
            sites.push_back(volume.site);
    }
    return sites;
}

Result<pipeline::MosaicRequest> mosaic_request(const stormcellar_grid_options& options,
                                               const stormcellar_mosaic_options* mosaic,
                                               const std::vector<grid::SitePosition>& sites) {
    pipeline::MosaicRequest request;
    auto spec = spec_of(options, sites);
    if (!spec) return pass_on(spec);
    request.domain = std::move(*spec);
    const auto gridder = gridder_of(options);
    if (!gridder) return pass_on(gridder);
    const auto rule = rule_of(mosaic, gridder->moment);
    if (!rule) return pass_on(rule);
    auto chain = chain_of(options, gridder->moment, rule->overlap);
    if (!chain) return pass_on(chain);
    request.chain = std::move(*chain);
    request.partial.gridder = *gridder;
    request.frame.overlap = *rule;
    request.frame.overlap.threads = gridder->threads;
    if (options.average_in_z != 0) request.frame.overlap.averaging = grid::Averaging::in_z;
    request.frame.threads = gridder->threads;
    return request;
}

Status make_mosaic(const stormcellar_volume* const* volumes, std::size_t count,
                   const stormcellar_grid_options* options,
                   const stormcellar_mosaic_options* mosaic_options, stormcellar_grid** mosaic) {
    if (mosaic == nullptr) return is_null("mosaic");
    *mosaic = nullptr;
    const auto all = all_of(volumes, count, "volume");
    if (!all) return pass_on(all);
    std::vector<pipeline::SceneVolume> scene;
    for (const stormcellar_volume* one : *all) {
        const auto site = site_of(*one);
        if (!site) return pass_on(site);
        const grid::SourceVolume& source = one->source;
        scene.push_back({&source.volume, *site, one->file, source.partial, source.notes});
    }
    const auto grid_options = take(options);
    if (!grid_options) return pass_on(grid_options);
    const auto request = mosaic_request(*grid_options, mosaic_options, sites_of(scene));
    if (!request) return pass_on(request);
    auto made = pipeline::make_mosaic(scene, *request);
    if (!made) return pass_on(made);
    *mosaic = new stormcellar_grid{std::move(made->grid), grid_options->mean_of_cell != 0};
    return {};
}

}  // namespace
}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_grid_merge(const stormcellar_grid* const* grids, size_t count,
                                        const stormcellar_mosaic_options* options,
                                        stormcellar_grid** merged, stormcellar_error* error) {
    return capi::guarded(error, [&] { return capi::merge(grids, count, options, merged); });
}

stormcellar_code stormcellar_mosaic_make(const stormcellar_volume* const* volumes, size_t count,
                                         const stormcellar_grid_options* options,
                                         const stormcellar_mosaic_options* mosaic_options,
                                         stormcellar_grid** mosaic, stormcellar_error* error) {
    return capi::guarded(
        error, [&] { return capi::make_mosaic(volumes, count, options, mosaic_options, mosaic); });
}

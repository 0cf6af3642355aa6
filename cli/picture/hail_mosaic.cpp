#include "cli/picture/hail_mosaic.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "cli/grid/grid_files.h"
#include "pipeline/keep/geometry_cache.h"
#include "pipeline/mosaic/hail_of_frame.h"
#include "pipeline/plan/mosaic_of_volumes.h"
#include "retrieve/hail/hail_mosaic.h"

namespace stormcellar::cli {
namespace {

std::vector<pipeline::SceneVolume> volumes_of(const std::vector<pipeline::SceneVolume>& all,
                                              const std::string& icao) {
    std::vector<pipeline::SceneVolume> some;
    std::ranges::copy_if(all, std::back_inserter(some), [&](const pipeline::SceneVolume& volume) {
        return volume.site.icao == icao;
    });
    return some;
}

// Replaces the columns of hail by those of the radar that sees the most.
Status take_largest_hail(const std::vector<pipeline::SceneVolume>& volumes,
                         pipeline::MosaicRequest request, const retrieve::FreezingLevels& levels,
                         pipeline::GeometryCache& geometries, grid::Grid& mosaic) {
    auto hail = retrieve::HailMosaic::make(mosaic.spec, levels);
    if (!hail) return pass_on(hail);
    request.instant = mosaic.frame_time;
    for (const grid::SitePosition& site : mosaic.sites) {
        const auto of_site =
            pipeline::make_mosaic(volumes_of(volumes, site.icao), request, geometries);
        if (!of_site) return pass_on(of_site);
        if (Status added = hail->add(of_site->grid, mosaic); !added) return added;
    }
    mosaic.provenance.notes.emplace_back(pipeline::merged_hail_note);
    return {};
}

}  // namespace

Result<PictureGrid> hail_grid_of_files(GridOptions options,
                                       const retrieve::FreezingLevels& levels) {
    // Standard input can be read only once.
    if (options.files == std::vector<std::string>{"-"})
        return PictureGrid::make(std::move(options));
    const GridOptions typed = options;
    const auto inputs = find_inputs(options);
    if (!inputs) return pass_on(inputs);
    if (options.files.size() == 1) return PictureGrid::make(typed);
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    request->inputs = *inputs;
    const auto moments = parse_each_moment(options, *request, EffectOptions{}, MosaicOptions{});
    if (!moments) return pass_on(moments);
    auto sources = load_mosaic(options.files, *request);
    if (!sources) return pass_on(sources);
    const auto volumes = sources->scene_volumes();
    const auto mosaic =
        mosaic_request(*sources, *request, moments->front().mosaic, moments->front().effects);
    pipeline::GeometryCache geometries(pipeline::mosaic_geometries);
    auto made = pipeline::make_mosaic(volumes, mosaic, geometries);
    if (!made) return pass_on(made);
    if (made->grid.sites.size() > 1) {
        const Status taken = take_largest_hail(volumes, mosaic, levels, geometries, made->grid);
        if (!taken) return pass_on(taken);
    }
    return PictureGrid::of_grid(std::move(made->grid), std::move(sources->volumes),
                                request->threads);
}

}  // namespace stormcellar::cli

#include "pipeline/plan/mosaic_of_volumes.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/steady_time.h"
#include "grid/plan/grid_effects.h"
#include "pipeline/plan/mosaic_plan.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::pipeline {
namespace {

// Returns the default choice, with the beam width of the radar at this site.
MosaicChoice default_choice_at(const MosaicRequest& request, const grid::SitePosition& site) {
    return mosaic_choice(request.chain, default_mosaic_choice(request.chain, request.domain,
                                                              grid::beam_width_of(site.icao)));
}

// Returns the middle of the time that a volume covers.
std::optional<UtcTime> middle_time(const level2::Volume& volume) {
    const std::optional<UtcTime> start = volume.start_time();
    if (!start) return std::nullopt;
    UtcTime end = *start;
    for (const level2::Sweep& sweep : volume.sweeps) {
        for (const level2::Radial& radial : sweep.radials) {
            if (level2::is_time_of_volume(radial.time, start)) end = std::max(end, radial.time);
        }
    }
    return *start + (end - *start) / 2;
}

void note_left_out(const std::vector<SceneVolume>& volumes, std::chrono::milliseconds greatest_gap,
                   grid::Grid& grid) {
    const auto& used = grid.provenance.source_files;
    for (const SceneVolume& volume : volumes) {
        const std::string file = std::filesystem::path(volume.file).filename().string();
        if (std::ranges::find(used, file) != used.end()) continue;
        const auto middle = middle_time(*volume.volume);
        if (!middle || std::chrono::abs(*middle - grid.time) <= greatest_gap) continue;
        grid.provenance.notes.push_back(
            fmt::format("{}: {} is left out: its middle, {}, is more than {} minutes from {}",
                        volume.site.icao, file, format_utc(*middle),
                        std::chrono::duration_cast<std::chrono::minutes>(greatest_gap).count(),
                        format_utc(grid.time)));
    }
}

grid::Grid dense_grid_of(const MosaicFrame& frame) {
    grid::Grid grid = grid::to_dense(frame.mosaic.cells.view());
    grid.moment = frame.description.moment;
    grid.time = frame.description.time;
    grid.start_time = frame.description.start_time;
    grid.end_time = frame.description.end_time;
    grid.frame_time = frame.description.time;
    grid.sites = frame.description.sites;
    grid.provenance = frame.description.provenance;
    // If no site sees a cell, its count and weight must be 0. to_dense() gives this value to cells
    // without a value.
    if (frame.mosaic.counts) {
        const grid::Grid counts = grid::to_dense(frame.mosaic.counts->view());
        grid.site_counts.assign(counts.values.begin(), counts.values.end());
    }
    if (frame.mosaic.weights) {
        grid.site_weights = std::move(grid::to_dense(frame.mosaic.weights->view()).values);
    }
    return grid;
}

Result<MosaicFrame> frame_plainly(const std::vector<SceneVolume>& volumes,
                                  const MosaicRequest& request, GeometryCache& geometries,
                                  MosaicOfVolumes& made) {
    Stopwatch watch;
    const auto partials = grid_volumes(volumes, request, geometries);
    if (!partials) return pass_on(partials);
    made.grid_s = watch.lap_s();
    const auto views = views_of(*partials);
    const UtcTime instant = request.instant.value_or(instant_of_newest(views));
    const MosaicChoice choice = default_choice_at(request, volumes.front().site);
    auto frame =
        make_frame(request.domain, views, instant, with_choice(request.frame, choice), geometries);
    made.merge_s = watch.lap_s();
    return frame;
}

// Makes the frame by a plan. Returns none if the budget cannot be met.
Result<std::optional<MosaicFrame>> frame_by_plan(const std::vector<SceneVolume>& volumes,
                                                 const MosaicRequest& request,
                                                 MosaicOfVolumes& made) {
    Stopwatch watch;
    auto scene = scene_of(volumes, request);
    if (!scene) return pass_on(scene);
    auto planned = plan_mosaic(*scene, request.chain, request.budget);
    if (!planned) return pass_on(planned);
    made.plan = std::move(planned->plan);
    made.plan_s = watch.lap_s();
    if (!made.plan->meets_budget) return std::optional<MosaicFrame>{};
    if (auto gridded = scene->partials(planned->choice); !gridded) return pass_on(gridded);
    made.grid_s = watch.lap_s();
    auto frame = scene->frame(planned->choice);
    if (!frame) return pass_on(frame);
    made.merge_s = watch.lap_s();
    frame->description.provenance.predicted_error = grid::predicted_error(*made.plan);
    frame->description.provenance.effects = made.plan->description;
    return std::optional<MosaicFrame>{std::move(*frame)};
}

}  // namespace

Result<std::vector<MadePartial>> grid_volumes(const std::vector<SceneVolume>& volumes,
                                              const MosaicRequest& request,
                                              GeometryCache& geometries) {
    std::vector<MadePartial> partials;
    for (const SceneVolume& volume : volumes) {
        const MosaicChoice choice = default_choice_at(request, volume.site);
        auto made = make_partials({&volume, 1}, request.domain,
                                  with_choice(request.partial, choice), geometries);
        if (!made) return pass_on(made);
        partials.push_back(std::move(made->front()));
    }
    return partials;
}

Result<MosaicScene> scene_of(const std::vector<SceneVolume>& volumes,
                             const MosaicRequest& request) {
    MosaicSceneOptions options;
    options.frame = request.frame;
    options.partial = request.partial;
    options.instant = request.instant;
    return MosaicScene::make(volumes, request.domain, request.chain, options);
}

Result<MosaicOfVolumes> make_mosaic(const std::vector<SceneVolume>& volumes,
                                    const MosaicRequest& request) {
    GeometryCache geometries(mosaic_geometries);
    return make_mosaic(volumes, request, geometries);
}

Result<MosaicOfVolumes> make_mosaic(const std::vector<SceneVolume>& volumes,
                                    const MosaicRequest& request, GeometryCache& geometries) {
    MosaicOfVolumes made;
    std::optional<MosaicFrame> frame;
    if (request.is_planned) {
        auto planned = frame_by_plan(volumes, request, made);
        if (!planned) return pass_on(planned);
        frame = std::move(*planned);
    } else {
        auto plain = frame_plainly(volumes, request, geometries, made);
        if (!plain) return pass_on(plain);
        frame = std::move(*plain);
    }
    if (!frame) return made;
    made.grid = dense_grid_of(*frame);
    note_left_out(volumes, request.frame.greatest_gap, made.grid);
    return made;
}

}  // namespace stormcellar::pipeline

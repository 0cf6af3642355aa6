#include "cli/picture/picture_grid.h"

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "cli/grid/grid_files.h"
#include "cli/picture/rotation_track.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::cli {

struct PictureGrid::Stored {
    cache::GridFile file;
    std::string name;
    std::vector<SourceVolume> no_volumes;
};

struct PictureGrid::Made {
    std::string name;
    cache::GridDescription description;
    grid::BrickGrid bricks;
    std::vector<SourceVolume> volumes;
};

struct PictureGrid::Swept {
    std::string name;
    SweptVolume volume;  // has the sweep's gates
    PlacedSweep placed;
};

namespace {

// Adds the faults that the radars of the volumes report about themselves.
void add_troubles(const std::vector<SourceVolume>& volumes, grid::Grid& grid) {
    auto& troubles = grid.provenance.radar_troubles;
    for (const SourceVolume& source : volumes)
        troubles.insert(troubles.end(), source.radar_troubles.begin(), source.radar_troubles.end());
}

}  // namespace

void add_picture_grid_options(CLI::App& app, GridOptions& options) {
    add_place_options(app, options);
    add_volume_option(app, options);
    add_site_options(app, options.site);
}

bool has_picture_grid_options(const GridOptions& options) {
    const GridOptions usual;
    return !options.center.empty() || options.projection != usual.projection ||
           !options.parallels.empty() || !options.extent_km.empty() ||
           !options.extent_deg.empty() || options.spacing_km || options.spacing_deg ||
           !options.levels_km.empty() || options.volume > 0 || !options.site.station.empty() ||
           !options.site.position.empty();
}

PictureGrid::PictureGrid(std::unique_ptr<Stored> stored) : stored_(std::move(stored)) {}
PictureGrid::PictureGrid(std::unique_ptr<Made> made) : made_(std::move(made)) {}
PictureGrid::PictureGrid(std::unique_ptr<Swept> swept) : swept_(std::move(swept)) {}
PictureGrid::PictureGrid(PictureGrid&&) noexcept = default;
PictureGrid& PictureGrid::operator=(PictureGrid&&) noexcept = default;
PictureGrid::~PictureGrid() = default;

Result<PictureGrid> PictureGrid::open(const std::filesystem::path& file) {
    auto opened = cache::GridFile::open(file);
    if (!opened) return pass_on(opened);
    return PictureGrid(std::make_unique<Stored>(Stored{std::move(*opened), {}, {}}));
}

void take_moment(const render::SceneOptions& scene, GridOptions& grid) {
    grid.moment = render::moment_asked(scene);
    const bool is_off = scene.dealias == retrieve::dealiasing_name(retrieve::Dealiasing::off);
    grid.dealias = is_off ? "" : scene.dealias;
    const bool is_automatic = scene.storm_motion == retrieve::automatic_motion;
    grid.storm_motion = is_automatic ? "" : scene.storm_motion;
    grid.quality = scene.quality;
    grid.zero_c_m = scene.scene.freezing_levels.zero_c_m;
}

Result<PictureGrid> PictureGrid::make(GridOptions options) {
    auto grids = make_each(std::move(options));
    if (!grids) return pass_on(grids);
    return std::move(grids->front());
}

Result<std::vector<PictureGrid>> PictureGrid::make_each(GridOptions options) {
    const auto inputs = find_inputs(options);
    if (!inputs) return pass_on(inputs);
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    request->inputs = *inputs;
    const auto moments = parse_each_moment(options, *request, EffectOptions{}, MosaicOptions{});
    if (!moments) return pass_on(moments);
    GridTimings timings;
    std::vector<SourceVolume> volumes;
    auto grids = grid_inputs(options.files, *request, *moments, timings, &volumes);
    if (!grids) return pass_on(grids);
    std::vector<PictureGrid> made;
    for (auto& one : *grids) {
        add_troubles(volumes, one.grid);
        made.push_back(of_grid(std::move(one.grid), {}, request->threads));
    }
    made.front().made_->volumes = std::move(volumes);
    return made;
}

PictureGrid PictureGrid::of_grid(grid::Grid grid, std::vector<SourceVolume> volumes, int threads) {
    add_troubles(volumes, grid);
    return PictureGrid(std::make_unique<Made>(
        Made{fmt::format("{}", fmt::join(grid.provenance.stations, "+")), cache::describe(grid),
             grid::BrickGrid::from(grid, grid::default_quantization(grid.moment), threads),
             std::move(volumes)}));
}

Result<std::vector<PictureGrid>> PictureGrid::make_by_time(const GridOptions& options) {
    std::vector<PictureGrid> grids;
    for (const std::string& file : options.files) {
        GridOptions one = options;
        one.files = {file};
        auto made = make(std::move(one));
        if (!made) return pass_on(made);
        grids.push_back(std::move(*made));
    }
    std::ranges::stable_sort(grids, {},
                             [](const PictureGrid& grid) { return grid.description().time; });
    return grids;
}

Result<PictureGrid> PictureGrid::of_rain(std::string name, const render::RainTotalGrid& total) {
    auto bricks = total.bricks();
    if (!bricks) return pass_on(bricks);
    return of_bricks(std::move(name), total.description(), std::move(*bricks));
}

PictureGrid PictureGrid::of_bricks(std::string name, cache::GridDescription description,
                                   grid::BrickGrid bricks) {
    return PictureGrid(std::make_unique<Made>(
        Made{std::move(name), std::move(description), std::move(bricks), {}}));
}

Result<PictureGrid> PictureGrid::make_track(const GridOptions& options) {
    auto grids = make_by_time(options);
    if (!grids) return pass_on(grids);
    RotationTrack track;
    for (const PictureGrid& grid : *grids) {
        const Status added = track.add(grid.view(), grid.description(), options.threads);
        if (!added) return pass_on(added);
    }
    Made& newest = *grids->back().made_;
    newest.description = track.description();
    newest.bricks = track.take_bricks();
    return std::move(grids->back());
}

Result<PictureGrid> PictureGrid::of_sweep(SweptVolume volume, const render::Scene& scene,
                                          const grid::GridSpec* plane) {
    auto placed = place_sweep(volume, scene, plane);
    if (!placed) return pass_on(placed);
    std::string name = volume.source().site.icao;
    return PictureGrid(
        std::make_unique<Swept>(Swept{std::move(name), std::move(volume), std::move(*placed)}));
}

grid::BrickView PictureGrid::view() const {
    if (swept_) {
        grid::BrickView view;
        view.spec = &swept_->placed.description.spec;
        view.sweep = &swept_->placed.sweep;
        return view;
    }
    return stored_ ? stored_->file.view() : made_->bricks.view();
}

const cache::GridDescription& PictureGrid::description() const {
    if (swept_) return swept_->placed.description;
    return stored_ ? stored_->file.description() : made_->description;
}

const std::string& PictureGrid::name() const {
    if (swept_) return swept_->name;
    return stored_ ? stored_->name : made_->name;
}

const std::vector<SourceVolume>& PictureGrid::volumes() const {
    if (swept_) return *swept_->volume.volumes;
    return stored_ ? stored_->no_volumes : made_->volumes;
}

Status PictureGrid::check_whole() const {
    return stored_ ? stored_->file.check_whole() : Status{};
}

}  // namespace stormcellar::cli

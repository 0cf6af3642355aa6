#include "cli/picture/picture_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "cli/grid/grid_files.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/sweep_lookup.h"

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
    cache::GridDescription description;
    // One, which the sweep is read from.
    std::shared_ptr<const std::vector<SourceVolume>> volumes;
    grid::SweepLookup sweep;
};

namespace {

constexpr double same_elevation_deg = 0.2;

grid::SweepWish wish_of(const render::Scene& scene, const std::optional<UtcTime>& time) {
    grid::SweepWish wish;
    if (scene.elevation_deg != render::Scene::lowest_sweep) {
        wish.elevation_deg = scene.elevation_deg;
    }
    if (scene.sweep_number != render::Scene::no_number) {
        wish.number = static_cast<std::size_t>(scene.sweep_number);
    }
    wish.nearest_to = time;
    return wish;
}

// Returns the cuts of the pattern at the angle nearest to the wish; empty if the sweep is wished by
// its number, which counts all sweeps.
std::vector<int> cuts_of(const level2::Volume& volume, const grid::SweepWish& wish) {
    if (wish.number || !volume.vcp_message || volume.vcp_message->cuts.empty()) return {};
    const auto& cuts = volume.vcp_message->cuts;
    const auto off_deg = [&](const level2::VcpCut& cut) {
        const auto angle_deg = static_cast<double>(cut.elevation_deg);
        return wish.elevation_deg ? std::abs(angle_deg - *wish.elevation_deg) : angle_deg;
    };
    const auto nearest_deg =
        static_cast<double>(std::ranges::min_element(cuts, {}, off_deg)->elevation_deg);
    std::vector<int> numbers;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const double apart_deg = static_cast<double>(cuts[i].elevation_deg) - nearest_deg;
        if (std::abs(apart_deg) <= same_elevation_deg) numbers.push_back(static_cast<int>(i) + 1);
    }
    return numbers;
}

// Returns the plane on which the sweep is drawn. Its cells, which only formats of maps show, are as
// wide as gates.
Result<grid::GridSpec> plane_of(GridRequest request, const GridOptions& options,
                                const grid::SweepLookup& sweep) {
    const grid::SweepFacts& facts = sweep.facts();
    const bool has_spacing = options.spacing_km || options.spacing_deg;
    if (!has_spacing) {
        request.spacing = facts.gate_spacing_m / 1000;
        request.spacing_unit = SizeUnit::km;
    }
    if (!request.extent_given) {
        const double cells = std::ceil(facts.greatest_arc_m / facts.gate_spacing_m);
        const double km = 2 * cells * facts.gate_spacing_m / 1000;
        request.extent = {km, km};
        request.extent_unit = SizeUnit::km;
    }
    request.levels_m = {std::clamp(sweep.site().altitude_m, -1e3, 6e4)};
    const auto [latitude_deg, longitude_deg] = request.center_deg.value_or(
        std::array<double, 2>{sweep.site().latitude_deg, sweep.site().longitude_deg});
    return spec_about(request, latitude_deg, longitude_deg);
}

cache::GridDescription describe_sweep(const grid::SweepLookup& sweep, grid::GridSpec plane,
                                      const SourceVolume& source, const std::string& file) {
    const grid::SweepFacts& facts = sweep.facts();
    cache::GridDescription description;
    description.spec = std::move(plane);
    description.moment = sweep.moment();
    const bool has_times = level2::is_plausible(facts.start) && facts.start != UtcTime{};
    const UtcTime of_volume = source.volume.start_time().value_or(UtcTime{});
    description.time = has_times ? facts.start : of_volume;
    description.start_time = description.time;
    description.end_time = has_times ? facts.end : of_volume;
    description.sites = {sweep.site()};
    grid::Provenance& provenance = description.provenance;
    provenance.source_files = {std::filesystem::path{file}.filename().string()};
    provenance.stations = {sweep.site().icao};
    provenance.method = fmt::format("the gates of one sweep (cut {}, {:.2f} degrees, {} radials)",
                                    facts.cut, facts.elevation_deg, facts.radial_count);
    provenance.beam_model = "4/3 earth";
    provenance.vcp = source.volume.vcp.value_or(0);
    provenance.partial = source.partial;
    provenance.notes = source.notes;
    provenance.radar_troubles = source.radar_troubles;
    return description;
}

}  // namespace

void add_picture_grid_options(CLI::App& app, GridOptions& options) {
    add_place_options(app, options);
    add_site_options(app, options.site);
}

bool has_picture_grid_options(const GridOptions& options) {
    const GridOptions usual;
    return !options.center.empty() || options.projection != usual.projection ||
           !options.parallels.empty() || !options.extent_km.empty() ||
           !options.extent_deg.empty() || options.spacing_km || options.spacing_deg ||
           !options.levels_km.empty() || !options.site.station.empty() ||
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

Result<PictureGrid> PictureGrid::make(GridOptions options) {
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
    grid::Grid& grid = grids->front().grid;
    for (const SourceVolume& source : volumes) {
        auto& troubles = grid.provenance.radar_troubles;
        troubles.insert(troubles.end(), source.radar_troubles.begin(), source.radar_troubles.end());
    }
    auto made = std::make_unique<Made>(
        Made{fmt::format("{}", fmt::join(grid.provenance.stations, "+")), cache::describe(grid),
             grid::BrickGrid::from(grid, grid::default_quantization(grid.moment), request->threads),
             std::move(volumes)});
    return PictureGrid(std::move(made));
}

Result<PictureGrid> PictureGrid::make_sweep(GridOptions options, const render::Scene& scene) {
    const auto inputs = find_inputs(options);
    if (!inputs) return pass_on(inputs);
    if (options.files.size() != 1) {
        return fail(ErrorCode::bad_argument, "a ppi is drawn of one file, not of {}",
                    options.files.size());
    }
    const std::string& file = options.files.front();
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    request->inputs = *inputs;
    const grid::SweepWish wish = wish_of(scene, request->frame_time);
    auto source = load_volume(
        file, *request, [&wish](const level2::Volume& volume) { return cuts_of(volume, wish); });
    if (!source) return pass_on(source);
    auto volumes = std::make_shared<std::vector<SourceVolume>>();
    volumes->push_back(std::move(*source));
    const SourceVolume& kept = volumes->front();
    auto sweep = grid::SweepLookup::find({volumes, &kept.volume}, kept.site, request->moment,
                                         grid::beam_width_of(kept.site.icao) / 2, wish);
    if (!sweep) return fail(sweep.error().code, "{}: {}", file, sweep.error().message);
    auto plane = plane_of(*request, options, *sweep);
    if (!plane) return pass_on(plane);
    auto description = describe_sweep(*sweep, std::move(*plane), kept, file);
    return PictureGrid(std::make_unique<Swept>(
        Swept{kept.site.icao, std::move(description), std::move(volumes), std::move(*sweep)}));
}

grid::BrickView PictureGrid::view() const {
    if (swept_) {
        grid::BrickView view;
        view.spec = &swept_->description.spec;
        view.sweep = &swept_->sweep;
        return view;
    }
    return stored_ ? stored_->file.view() : made_->bricks.view();
}

const cache::GridDescription& PictureGrid::description() const {
    if (swept_) return swept_->description;
    return stored_ ? stored_->file.description() : made_->description;
}

const std::string& PictureGrid::name() const {
    if (swept_) return swept_->name;
    return stored_ ? stored_->name : made_->name;
}

const std::vector<SourceVolume>& PictureGrid::volumes() const {
    if (swept_) return *swept_->volumes;
    return stored_ ? stored_->no_volumes : made_->volumes;
}

Status PictureGrid::check_whole() const {
    return stored_ ? stored_->file.check_whole() : Status{};
}

}  // namespace stormcellar::cli

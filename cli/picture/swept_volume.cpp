#include "cli/picture/swept_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "cli/grid/grid_files.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::cli {
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

// Returns the cuts of the pattern at the angle nearest to the wish. Empty, which is all cuts: the
// sweep is wished by its number, which counts all sweeps, or no cut is near, which an error tells
// with all angles that there are.
std::vector<int> cuts_of(const level2::Volume& volume, const grid::SweepWish& wish) {
    if (wish.number || !volume.vcp_message || volume.vcp_message->cuts.empty()) return {};
    const auto& cuts = volume.vcp_message->cuts;
    const auto off_deg = [&](const level2::VcpCut& cut) {
        const auto angle_deg = static_cast<double>(cut.elevation_deg);
        return wish.elevation_deg ? std::abs(angle_deg - *wish.elevation_deg) : angle_deg;
    };
    const auto nearest = std::ranges::min_element(cuts, {}, off_deg);
    if (wish.elevation_deg && off_deg(*nearest) > grid::SweepWish::farthest_deg) return {};
    const auto nearest_deg = static_cast<double>(nearest->elevation_deg);
    std::vector<int> numbers;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const double apart_deg = static_cast<double>(cuts[i].elevation_deg) - nearest_deg;
        if (std::abs(apart_deg) <= same_elevation_deg) numbers.push_back(static_cast<int>(i) + 1);
    }
    return numbers;
}

// Returns the plane on which the sweep is drawn. Its cells, which only formats of maps show, are as
// wide as gates.
Result<grid::GridSpec> plane_of(const SweptVolume& volume, const grid::SweepLookup& sweep) {
    const grid::SweepFacts& facts = sweep.facts();
    GridRequest request = volume.request;
    if (!volume.spacing_given) {
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
                                      const SweptVolume& volume) {
    const grid::SweepFacts& facts = sweep.facts();
    const SourceVolume& source = volume.source();
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
    provenance.source_files = {std::filesystem::path{volume.file}.filename().string()};
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

ChooseCuts chooser_of(const render::Scene* shown, const GridRequest& request) {
    if (shown == nullptr) return {};
    return [wish = wish_of(*shown, request.frame_time)](const level2::Volume& volume) {
        return cuts_of(volume, wish);
    };
}

SweptVolume swept_volume(std::string file, GridRequest request, const GridOptions& options,
                         SourceVolume source) {
    auto volumes = std::make_shared<std::vector<SourceVolume>>();
    volumes->push_back(std::move(source));
    return {std::move(file), std::move(request), options.spacing_km || options.spacing_deg,
            std::move(volumes)};
}

}  // namespace

Result<SweptVolume> read_sweeps(GridOptions options, const render::Scene* shown) {
    const auto inputs = find_inputs(options);
    if (!inputs) return pass_on(inputs);
    if (options.files.size() != 1) {
        return fail(ErrorCode::bad_argument, "a ppi is drawn of one file, not of {}",
                    options.files.size());
    }
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    request->inputs = *inputs;
    const std::string& file = options.files.front();
    auto source = load_volume(file, *request, chooser_of(shown, *request));
    if (!source) return pass_on(source);
    return swept_volume(file, std::move(*request), options, std::move(*source));
}

Result<SweptVolume> decode_sweeps(std::span<const std::byte> bytes, const std::string& file,
                                  const GridOptions& options, const render::Scene* shown) {
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    auto source = decode_volume(bytes, file, *request, chooser_of(shown, *request));
    if (!source) return pass_on(source);
    return swept_volume(file, std::move(*request), options, std::move(*source));
}

Result<PlacedSweep> place_sweep(const SweptVolume& volume, const render::Scene& scene,
                                const grid::GridSpec* plane) {
    const SourceVolume& source = volume.source();
    auto sweep = grid::SweepLookup::find(
        {volume.volumes, &source.volume}, source.site, volume.request.moment,
        grid::beam_width_of(source.site.icao) / 2, wish_of(scene, volume.request.frame_time));
    if (!sweep) return fail(sweep.error().code, "{}: {}", volume.file, sweep.error().message);
    auto own = plane != nullptr ? Result<grid::GridSpec>{*plane} : plane_of(volume, *sweep);
    if (!own) return pass_on(own);
    auto description = describe_sweep(*sweep, std::move(*own), volume);
    return PlacedSweep{std::move(description), std::move(*sweep)};
}

std::vector<double> elevations_of(const SweptVolume& volume) {
    const SourceVolume& source = volume.source();
    return grid::elevations_deg(source.volume, volume.request.moment,
                                grid::beam_width_of(source.site.icao) / 2);
}

}  // namespace stormcellar::cli

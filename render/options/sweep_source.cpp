#include "render/options/sweep_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::render {
namespace {

constexpr double same_elevation_deg = 0.2;
// The lowest and the highest level that a grid may have.
constexpr double lowest_level_m = -1e3, highest_level_m = 6e4;

}  // namespace

grid::SweepWish sweep_wish_of(const Scene& scene, std::optional<UtcTime> nearest_to) {
    grid::SweepWish wish;
    if (scene.elevation_deg != Scene::lowest_sweep) wish.elevation_deg = scene.elevation_deg;
    if (scene.sweep_number != Scene::no_number)
        wish.number = static_cast<std::size_t>(scene.sweep_number);
    wish.nearest_to = nearest_to;
    return wish;
}

std::vector<int> cuts_of_wish(const level2::Volume& volume, const grid::SweepWish& wish) {
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

grid::GridSpec plane_of_sweep(const grid::SweepLookup& sweep) {
    const grid::SweepFacts& facts = sweep.facts();
    grid::GridSpec plane =
        grid::default_spec(sweep.site().latitude_deg, sweep.site().longitude_deg);
    plane.spacing_m = facts.gate_spacing_m;
    plane.nx = 2 * static_cast<int>(std::ceil(facts.greatest_arc_m / facts.gate_spacing_m));
    plane.ny = plane.nx;
    plane.levels_m = {std::clamp(sweep.site().altitude_m, lowest_level_m, highest_level_m)};
    return plane;
}

cache::GridDescription describe_sweep(const grid::SweepLookup& sweep, grid::GridSpec plane,
                                      const grid::SourceVolume& source, const std::string& file) {
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

}  // namespace stormcellar::render

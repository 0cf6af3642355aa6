#include "cli/grid/grid_notes.h"

#include <algorithm>
#include <chrono>

namespace stormcellar::cli {
namespace {

constexpr double farthest_guess_m = 500;
constexpr std::chrono::hours usual_distance{1};

// Returns the span as text, for example "27 years", "3 days" or "1.5 hours".
std::string span_text(std::chrono::milliseconds span) {
    using std::chrono::duration;
    const auto hours = duration<double, std::chrono::hours::period>(span).count();
    const auto days = duration<double, std::chrono::days::period>(span).count();
    const auto years = duration<double, std::chrono::years::period>(span).count();
    if (years >= 2) return fmt::format("{:.0f} years", years);
    if (days >= 2) return fmt::format("{:.0f} days", days);
    return fmt::format("{:.1f} hours", hours);
}

}  // namespace

std::optional<std::string> note_on_sounding(const EffectRequest& effects,
                                            const grid::SitePosition& site) {
    if (!effects.sounding_from_m) return std::nullopt;
    const double guessed_m = *effects.sounding_from_m - site.altitude_m;
    if (!(guessed_m > farthest_guess_m)) return std::nullopt;
    return fmt::format(
        "the {} is extrapolated from its first level, at {:.0f} m, down to the antenna, at {:.0f} "
        "m above mean sea level",
        effects.profile.name(), *effects.sounding_from_m, site.altitude_m);
}

std::optional<std::string> note_on_frame_time(const grid::Grid& grid) {
    if (!grid.frame_time) return std::nullopt;
    const auto after = *grid.frame_time - grid.end_time;
    const auto before = grid.start_time - *grid.frame_time;
    if (std::max(after, before) <= usual_distance) return std::nullopt;
    return fmt::format("the grid's time is {} {} the volume, which is of {}",
                       span_text(std::max(after, before)), after > before ? "after" : "before",
                       format_utc(grid.time));
}

std::optional<std::string> note_on_cells(const grid::Grid& grid) {
    const bool seen =
        std::any_of(grid.status.begin(), grid.status.end(),
                    [](grid::CellStatus status) { return status != grid::CellStatus::not_seen; });
    if (seen) return std::nullopt;
    const grid::SitePosition& site = grid.sites.front();
    return fmt::format("{}, at {:.4f},{:.4f}, sees no cell of the grid around {:.4f},{:.4f}",
                       site.icao, site.latitude_deg, site.longitude_deg,
                       grid.spec.center_latitude_deg, grid.spec.center_longitude_deg);
}

std::vector<std::string> notes_on(const grid::Grid& grid, const EffectRequest& effects) {
    std::vector<std::string> notes;
    const auto add = [&](std::optional<std::string> note) {
        if (note) notes.push_back(std::move(*note));
    };
    if (effects.profile_bends_nothing) {
        notes.emplace_back(
            "--profile does not bend the beams of this grid, because refraction is off; it only "
            "changes the predicted error");
    }
    add(note_on_sounding(effects, grid.sites.front()));
    add(note_on_frame_time(grid));
    add(note_on_cells(grid));
    return notes;
}

}  // namespace stormcellar::cli

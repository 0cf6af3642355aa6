#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "base/printable.h"
#include "stormcellar/export/cell_text.h"

namespace stormcellar::cell_export {
namespace {

using retrieve::TrackedCell;

constexpr double feet_per_m = 1 / 0.3048, knots_per_mps = 1 / 0.514444;
constexpr std::string_view cell_color = "255 255 255", track_color = "190 190 190",
                           forecast_color = "255 220 80";

// Returns text from outside without the characters that end a text or a comment.
std::string harmless(std::string_view text) {
    std::string safe = printable(text);
    std::ranges::replace(safe, '"', '\'');
    std::ranges::replace(safe, ';', ',');
    return safe;
}

std::string point_text(grid::GeoPoint place) {
    return fmt::format("{:.5f}, {:.5f}", place.latitude_deg, place.longitude_deg);
}

// Returns the text of a pointer over the cell. Readers turn the two characters \n into a new line.
std::string hover_text(const TrackedCell& cell) {
    std::string text = fmt::format(
        "{}\\n{}{}\\nMax {:.0f} dBZ at {:.0f} kft\\nTop {}{:.0f} kft\\nVIL {:.0f} kg/m2", cell.id,
        retrieve::cell_origin_name(cell.origin),
        cell.parents.empty() ? "" : fmt::format(" from {}", fmt::join(cell.parents, " and ")),
        cell.cell.max_dbz, cell.cell.max_dbz_height_m * feet_per_m / 1000,
        cell.cell.top_is_at_least ? "at least " : "", cell.cell.top_m * feet_per_m / 1000,
        cell.cell.vil_kg_per_m2);
    if (cell.cell.mesh_mm) text += fmt::format("\\nMESH {:.0f} mm", *cell.cell.mesh_mm);
    if (cell.cell.azimuthal_shear_per_s)
        text += fmt::format("\\nShear {:.4f} /s", *cell.cell.azimuthal_shear_per_s);
    if (cell.motion)
        text += fmt::format("\\nFrom {:.0f} deg at {:.0f} kt +- {:.0f} kt",
                            cell.motion->velocity.direction_deg(),
                            cell.motion->velocity.speed_mps() * knots_per_mps,
                            cell.motion->error_mps * knots_per_mps);
    return harmless(text);
}

std::string placefile_line(std::string_view color, int width, std::string_view hover,
                           std::span<const grid::GeoPoint> places) {
    std::string text = fmt::format("Color: {}\nLine: {}, 0, \"{}\"\n", color, width, hover);
    for (const grid::GeoPoint& place : places)
        text += fmt::format(" {}\n", point_text(place));
    return text + "End:\n";
}

std::string track_lines(const TrackedCell& cell) {
    std::string text;
    std::vector<grid::GeoPoint> places;
    for (const retrieve::CellSighting& sighting : cell.past)
        places.push_back(sighting.position);
    places.push_back(cell.cell.position);
    if (places.size() > 1)
        text += placefile_line(track_color, 2, "track of " + harmless(cell.id), places);
    if (cell.forecasts.empty()) return text;
    places = {cell.cell.position};
    for (const retrieve::CellForecast& forecast : cell.forecasts)
        places.push_back(forecast.position);
    text += placefile_line(forecast_color, 2, "forecast of " + harmless(cell.id), places);
    for (const retrieve::CellForecast& forecast : cell.forecasts) {
        text +=
            fmt::format("Text: {}, 1, \"+\", \"{} min +- {:.0f} km\"\n",
                        point_text(forecast.position), forecast.minutes, forecast.error_m / 1000);
    }
    return text;
}

// Draws an octagon of pixels about the place, and the maximum beside it.
std::string cell_mark(const TrackedCell& cell) {
    constexpr int pixels = 8, sides = 8;
    std::string text = fmt::format("Color: {}\nObject: {}\n Line: 2, 0, \"{}\"\n", cell_color,
                                   point_text(cell.cell.position), hover_text(cell));
    for (int i = 0; i <= sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        text += fmt::format("  {}, {}\n", std::lround(pixels * std::sin(angle)),
                            std::lround(pixels * std::cos(angle)));
    }
    return text + fmt::format(" End:\n Text: 16, 10, 1, \"{:.0f}\", \"{}\"\nEnd:\n",
                              cell.cell.max_dbz, hover_text(cell));
}

}  // namespace

std::string cells_placefile(std::span<const TrackedCell> cells, const PlacefileLook& look) {
    std::string text =
        fmt::format("Title: {}\nRefresh: {}\nThreshold: 999\nFont: 1, 11, 1, \"Arial\"\n",
                    harmless(look.title), std::max(look.refresh_minutes, 1));
    for (const TrackedCell& cell : cells)
        text += track_lines(cell);
    // Cells come last, so that readers draw them above all lines.
    for (const TrackedCell& cell : cells)
        text += cell_mark(cell);
    return text;
}

}  // namespace stormcellar::cell_export

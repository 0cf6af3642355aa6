#include "cli/storms/cells_text.h"

#include <array>

#include "cli/shared/commands.h"
#include "stormcellar/export/cell_text.h"

namespace stormcellar::cli {
namespace {

using retrieve::TrackedCell;
using retrieve::TrackedScan;

constexpr double km = 1000;

std::string unknown_or(const std::optional<float>& value, std::string_view format) {
    return value ? fmt::format(fmt::runtime(format), *value) : std::string("-");
}

std::string motion_text(const TrackedCell& cell) {
    if (!cell.motion) return "-";
    return fmt::format("{:03.0f}/{:.0f} +- {:.0f}", cell.motion->velocity.direction_deg(),
                       cell.motion->velocity.speed_mps(), cell.motion->error_mps);
}

// Returns the origin, with the number of minutes since the first sight of a continued cell.
std::string history_text(const TrackedCell& cell) {
    std::string text(retrieve::cell_origin_name(cell.origin));
    if (!cell.past.empty()) {
        const double seconds = seconds_between(cell.past.front().time, cell.time);
        text += fmt::format(", {:.0f} min", seconds / 60);
    }
    return text;
}

}  // namespace

std::string cells_table(const TrackedScan& scan) {
    std::string text =
        fmt::format("{}  {}  {} {}\n", scan.area.empty() ? "unknown" : printable(scan.area),
                    format_utc(scan.time), scan.cells.size(), plural(scan.cells.size(), "cell"));
    if (scan.cells.empty()) return text;
    text += fmt::format("{:>9} {:>10} {:>5} {:>6} {:>7} {:>5} {:>5} {:>7} {:>5} {:>13}  {}\n",
                        "latitude", "longitude", "dBZ", "at km", "top km", "VIL", "MESH", "shear",
                        "km2", "from/m/s", "history");
    for (const TrackedCell& tracked : scan.cells) {
        const retrieve::StormCell& cell = tracked.cell;
        const std::string top =
            fmt::format("{}{:.1f}", cell.top_is_at_least ? ">" : "", cell.top_m / km);
        text += fmt::format(
            "{:9.3f} {:10.3f} {:5.1f} {:6.1f} {:>7} {:5.0f} {:>5} {:>7} {:5.0f} {:>13}  {}\n",
            cell.position.latitude_deg, cell.position.longitude_deg, cell.max_dbz,
            cell.max_dbz_height_m / km, top, cell.vil_kg_per_m2, unknown_or(cell.mesh_mm, "{:.0f}"),
            unknown_or(cell.azimuthal_shear_per_s, "{:.4f}"), cell.area_km2, motion_text(tracked),
            history_text(tracked));
    }
    return text;
}

std::span<const CellFormat> cell_formats() {
    static constexpr std::array<CellFormat, 4> formats = {{
        {"json", ".json", [](const TrackedScan& s) { return cell_export::cells_json(s); }},
        {"geojson", ".geojson", [](const TrackedScan& s) { return cell_export::cells_geojson(s); }},
        {"csv", ".csv", [](const TrackedScan& s) { return cell_export::cells_csv(s.cells); }},
        {"placefile", ".txt",
         [](const TrackedScan& s) {
             return cell_export::cells_placefile(
                 s.cells, {fmt::format("{} storm cells {}", s.area, format_utc(s.time)), 1});
         }},
    }};
    return formats;
}

}  // namespace stormcellar::cli

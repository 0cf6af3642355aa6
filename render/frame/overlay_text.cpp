#include "render/frame/overlay_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace stormcellar::render {
namespace {

std::string cells_counted(std::size_t count) {
    return fmt::format("{} storm {}", count, count == 1 ? "cell" : "cells");
}

}  // namespace

std::vector<std::string> cell_notes(const CellOverlay& overlay) {
    std::vector<std::string> notes = {
        cells_counted(overlay.scan.cells.size()) + ",",
        fmt::format("peaks from {:g} dBZ", overlay.method.least_peak_dbz)};
    if (overlay.volumes == 1) {
        notes.back() += ";";
        notes.emplace_back("1 volume: no motion,");
        notes.emplace_back("no forecast");
        return notes;
    }
    notes.push_back(fmt::format("over {} volumes;", overlay.volumes));
    notes.emplace_back("ticks: 15 to 60 min,");
    notes.emplace_back("circles: error");
    return notes;
}

std::string cells_method(const std::optional<retrieve::FreezingLevels>& freezing,
                         const retrieve::CellOptions& method) {
    std::string text = fmt::format(
        "echo of {:g} dBZ and more about peaks of {:g} dBZ and more, {:g} km2 and {:g} km deep",
        method.least_dbz, method.least_peak_dbz, method.least_area_km2,
        method.least_depth_m / 1000);
    if (freezing) {
        text += fmt::format("; MESH assumes 0 C at {:g} m, -20 C at {:g} m above sea level",
                            freezing->zero_c_m, freezing->minus_20_c_m);
    }
    return text;
}

std::string cells_sentence(const CellOverlay& overlay) {
    const std::string followed = overlay.volumes == 1
                                     ? std::string("of one volume, so without motion and forecast")
                                     : fmt::format("followed through {} volumes", overlay.volumes);
    return fmt::format("{} at {}, {}; {}", cells_counted(overlay.scan.cells.size()),
                       format_utc(overlay.scan.time), followed,
                       cells_method(overlay.scan.freezing, overlay.method));
}

std::string shapes_shown(const ShapeOverlay& shapes, UtcTime time) {
    const auto in_force = std::ranges::count_if(
        shapes.shapes, [time](const OverlayShape& shape) { return shape.is_in_force(time); });
    std::string text = fmt::format("{} of {} in force", in_force, shapes.shapes.size());
    if (shapes.unknown > 0) text += fmt::format(", {} unknown", shapes.unknown);
    return text;
}

}  // namespace stormcellar::render

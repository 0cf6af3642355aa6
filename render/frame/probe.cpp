#include "render/frame/probe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/floating_point.h"
#include "render/frame/picture_layout.h"
#include "render/map/map_lines.h"
#include "render/products/flat_field.h"
#include "render/products/ground.h"
#include "render/products/section.h"
#include "render/view/length_text.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/retrieve/hydrometeors.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;

void note_heights(const grid::BrickView& view, int ix, int iy, Probe& probe) {
    ColumnCells cells;
    read_column(view, ix, iy, cells);
    for (std::size_t i = 0; i < cells.status.size(); ++i) {
        if (cells.status[i] == CellStatus::not_seen) continue;
        if (!probe.lowest_seen_m) probe.lowest_seen_m = view.spec->levels_m[i];
        probe.highest_seen_m = view.spec->levels_m[i];
    }
}

// Returns the height of the lowest cell that has the column's largest value.
std::optional<double> height_of_maximum(const grid::BrickView& view, int ix, int iy) {
    ColumnCells cells;
    read_column(view, ix, iy, cells);
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < cells.status.size(); ++i) {
        if (cells.status[i] != CellStatus::value) continue;
        if (!best || cells.values[i] > cells.values[*best]) best = i;
    }
    return best ? std::optional{view.spec->levels_m[*best]} : std::nullopt;
}

Probe probe_sweep(const grid::SweepLookup& sweep, const Scene& scene, grid::GeoPoint place) {
    const grid::SiteFrame frame(sweep.site().latitude_deg, sweep.site().longitude_deg);
    const grid::PolarPoint from_radar = frame.to_polar(place);
    const grid::GateValue value = sweep.at(from_radar);
    Probe probe;
    probe.place = place;
    probe.status = value.status;
    probe.value = value.value;
    probe.unit = unit_shown(scene);
    if (level2::facts_of(scene.moment).is_categorical)
        probe.class_name = retrieve::hydrometeor_name(retrieve::hydrometeor_of_number(value.value));
    probe.gate = sweep.position(from_radar);
    if (probe.gate) probe.height_m = probe.gate->height_m;
    return probe;
}

Result<Probe> probe_column(const grid::BrickView& view, const FrameFacts& facts, const Scene& scene,
                           std::size_t column, grid::GeoPoint place, int threads) {
    if (view.sweep != nullptr) return probe_sweep(*view.sweep, scene, place);
    Scene map = scene;
    // For a volume, read the column's maximum over the ground under the pixel.
    if (view_of(scene.product) == View::volume) map.product = Product::composite;
    const auto field = map_field(view, facts, map, summarize_columns(view, threads), threads);
    if (!field) return pass_on(field);
    Probe probe;
    probe.place = place;
    probe.status = field->status[column];
    probe.value = field->values[column];
    probe.at_least = !field->at_least.empty() && field->at_least[column] != 0;
    probe.unit = unit_shown(map);
    const auto nx = static_cast<std::size_t>(view.spec->nx);
    const auto ix = static_cast<int>(column % nx);
    const auto iy = static_cast<int>(column / nx);
    if (map.product == Product::cappi) probe.height_m = scene.cappi_height_m;
    if (map.product == Product::composite) probe.height_m = height_of_maximum(view, ix, iy);
    note_heights(view, ix, iy, probe);
    return probe;
}

Result<Probe> probe_section(const grid::BrickView& view, const Scene& scene,
                            const LabelLayout& layout, int x, int y, int threads) {
    const SectionPlace at = section_place(layout.width, layout.height, layout.scale, scene.labels);
    if (!at.has(x, y)) {
        return fail(ErrorCode::bad_argument,
                    "pixel {},{} lies beside the section, which goes from {},{} to {},{}",
                    x + layout.left, y + layout.top, at.left + layout.left, at.top + layout.top,
                    at.left + layout.left + at.width - 1, at.top + layout.top + at.height - 1);
    }
    const Section section =
        cut_section(view, scene.moment, *scene.section, at.width, at.height, threads);
    const int column = x - at.left;
    const int row = at.height - 1 - (y - at.top);
    if (section.in_grid[static_cast<std::size_t>(column)] == 0) {
        return fail(ErrorCode::bad_argument, "the section lies outside the grid there");
    }
    Probe probe;
    const std::size_t place = section.field.index(column, row);
    probe.status = section.field.status[place];
    probe.value = section.field.values[place];
    probe.unit = unit_shown(scene);
    probe.height_m = std::lerp(section.bottom_m, section.top_m, (row + 0.5) / at.height);
    probe.distance_m = section.length_m * (column + 0.5) / at.width;
    const grid::SiteFrame start(scene.section->from.latitude_deg,
                                scene.section->from.longitude_deg);
    probe.place = start.to_geo({start.to_polar(scene.section->to).azimuth_deg, *probe.distance_m});
    const auto nearest = grid::GridProjection(*view.spec).to_column(probe.place);
    note_heights(view, std::clamp(static_cast<int>(std::lround(nearest.x)), 0, view.spec->nx - 1),
                 std::clamp(static_cast<int>(std::lround(nearest.y)), 0, view.spec->ny - 1), probe);
    return probe;
}

}  // namespace

Result<Probe> probe_pixel(const grid::BrickView& view, const FrameFacts& facts, const Scene& scene,
                          int x, int y, int threads) {
    if (auto valid = check_frame(view, facts, scene); !valid) return pass_on(valid);
    const auto layout = layout_of(view, facts, scene);
    if (!layout) return pass_on(layout);
    const int in_x = x - layout->left;
    const int in_y = y - layout->top;
    if (in_x < 0 || in_y < 0 || in_x >= layout->width || in_y >= layout->height) {
        return fail(ErrorCode::bad_argument,
                    "pixel {},{} lies outside the picture, which goes from {},{} to {},{}", x, y,
                    layout->left, layout->top, layout->left + layout->width - 1,
                    layout->top + layout->height - 1);
    }
    if (view_of(scene.product) == View::section) {
        return probe_section(view, scene, *layout, in_x, in_y, threads);
    }
    const grid::GridSpec& spec = *view.spec;
    const ViewGeometry geometry = picture_geometry(spec, scene, layout->width, layout->height);
    const auto ground = geometry.ground({in_x + 0.5, in_y + 0.5});
    const std::ptrdiff_t column = ground ? column_at(spec, *ground) : -1;
    if (column < 0) {
        return fail(ErrorCode::bad_argument, "pixel {},{} does not show the ground of the grid", x,
                    y);
    }
    const grid::GeoPoint place = grid::GridProjection(spec).to_geo(
        {ground->x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
         ground->y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1)});
    return probe_column(view, facts, scene, static_cast<std::size_t>(column), place, threads);
}

Result<Probe> probe_place(const grid::BrickView& view, const FrameFacts& facts, const Scene& scene,
                          grid::GeoPoint place, int threads) {
    if (auto valid = check_frame(view, facts, scene); !valid) return pass_on(valid);
    if (view_of(scene.product) == View::section) {
        return fail(ErrorCode::bad_argument,
                    "a section can only be probed at a pixel, not at a place");
    }
    const grid::GridSpec& spec = *view.spec;
    const auto known =
        is_within(place.latitude_deg, -90.0, 90.0) && is_within(place.longitude_deg, -180.0, 360.0);
    if (!known) {
        return fail(ErrorCode::bad_argument, "{},{} is not a latitude and a longitude",
                    place.latitude_deg, place.longitude_deg);
    }
    // Give longitudes in the west as negative numbers, as everywhere else.
    if (place.longitude_deg > 180) place.longitude_deg -= 360;
    const auto at = grid::GridProjection(spec).to_column(place);
    const double ix = std::floor(at.x + 0.5);
    const double iy = std::floor(at.y + 0.5);
    if (!is_within(ix, 0.0, spec.nx - 1.0) || !is_within(iy, 0.0, spec.ny - 1.0)) {
        return fail(ErrorCode::bad_argument, "{} lies outside the grid", place_text(place));
    }
    const std::size_t column = static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec.nx) +
                               static_cast<std::size_t>(ix);
    return probe_column(view, facts, scene, column, place, threads);
}

std::string probe_text(const Probe& probe, const Units& units) {
    if (probe.status != CellStatus::value) {
        std::string state{grid::cell_status_name(probe.status)};
        std::ranges::replace(state, '_', ' ');
        return state;
    }
    if (!probe.class_name.empty()) return probe.class_name;
    const ShownUnit unit = shown_unit(probe.unit, units);
    // Give a converted value no more digits than the stored value has.
    const int digits = unit.symbol == probe.unit ? 6 : 4;
    return (probe.at_least ? "at least " : "") + value_text(probe.value, unit, digits);
}

}  // namespace stormcellar::render

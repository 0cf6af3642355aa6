#include "render/products/section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "render/products/cell_mixer.h"
#include "render/products/ground.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {
namespace {

// The two indices around a place along an axis, and the weight of the second. There are none if the
// place is beyond the cells.
struct Neighbours {
    int first = 0, second = 0;
    double second_share = 0;
};
std::optional<Neighbours> neighbours(double at, int count) {
    if (!(at >= -0.5 && at <= count - 0.5)) return std::nullopt;
    const double inside = std::clamp(at, 0.0, count - 1.0);
    const int first = std::min(static_cast<int>(inside), std::max(0, count - 2));
    return Neighbours{first, std::min(first + 1, count - 1), inside - first};
}

// One of the four columns around a place, with its weight.
struct Corner {
    ColumnCells cells;
    double weight = 0;
};

std::array<Corner, 4> corners_at(const grid::BrickView& view, const Neighbours& across,
                                 const Neighbours& along) {
    std::array<Corner, 4> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const bool east = i % 2 == 1;
        const bool north = i >= 2;
        corners[i].weight = (east ? across.second_share : 1 - across.second_share) *
                            (north ? along.second_share : 1 - along.second_share);
        read_column(view, east ? across.second : across.first, north ? along.second : along.first,
                    corners[i].cells);
    }
    return corners;
}

grid::Sample sample_of(const ColumnCells& cells, float half_period, int level) {
    const auto i = static_cast<std::size_t>(level);
    return {cells.status[i], cells.values[i], 0, half_period};
}

// Returns, for each level, the common state of the four columns, or `value` if the columns differ
// or hold values.
std::vector<grid::CellStatus> states_of_all(const std::array<Corner, 4>& corners) {
    std::vector<grid::CellStatus> states = corners.front().cells.status;
    for (const Corner& corner : corners) {
        for (std::size_t level = 0; level < states.size(); ++level) {
            if (corner.cells.status[level] != states[level])
                states[level] = grid::CellStatus::value;
        }
    }
    return states;
}

}  // namespace

Section cut_section(const grid::BrickView& view, level2::Moment moment, const SectionLine& line,
                    int width, int height, int threads) {
    Section section;
    section.line = line;
    const grid::SiteFrame start(line.from.latitude_deg, line.from.longitude_deg);
    const grid::PolarPoint to_end = start.to_polar(line.to);
    section.length_m = to_end.arc_m;
    const HeightRange heights = height_range(*view.spec);
    section.bottom_m = std::min(0.0, heights.bottom_m);
    section.top_m = heights.top_m;
    section.field = FlatField(width, height);
    section.in_grid.assign(static_cast<std::size_t>(width), 0);

    std::vector<std::optional<LevelPair>> rows;
    for (int y = 0; y < height; ++y) {
        const double share = (y + 0.5) / height;
        const auto levels =
            levels_about(*view.spec, std::lerp(section.bottom_m, section.top_m, share));
        rows.push_back(levels ? std::optional{*levels} : std::nullopt);
    }
    const grid::GridProjection projection(*view.spec);
    const float half_period = grid::half_period_of(moment, 0);
    for_each_piece(width, threads, [&](int x) {
        const double arc_m = section.length_m * (x + 0.5) / width;
        const auto column = projection.to_column(start.to_geo({to_end.azimuth_deg, arc_m}));
        const auto across = neighbours(column.x, view.spec->nx);
        const auto along = neighbours(column.y, view.spec->ny);
        if (!across || !along) return;
        section.in_grid[static_cast<std::size_t>(x)] = 1;
        const std::array<Corner, 4> corners = corners_at(view, *across, *along);
        const auto states = states_of_all(corners);
        CellMixer mixer(moment);
        for (int y = 0; y < height; ++y) {
            const auto& levels = rows[static_cast<std::size_t>(y)];
            if (!levels) continue;
            // If all cells have one state, the result is that state. Most of a section is clear or
            // was not seen.
            const grid::CellStatus state = states[static_cast<std::size_t>(levels->lower)];
            if (state != grid::CellStatus::value &&
                state == states[static_cast<std::size_t>(levels->upper)]) {
                section.field.put(section.field.index(x, y), state, 0);
                continue;
            }
            mixer.clear();
            for (const Corner& corner : corners) {
                mixer.add(sample_of(corner.cells, half_period, levels->lower),
                          corner.weight * (1 - levels->upper_share));
                mixer.add(sample_of(corner.cells, half_period, levels->upper),
                          corner.weight * levels->upper_share);
            }
            const grid::CellResult cell = mixer.result();
            section.field.put(section.field.index(x, y), cell.status, cell.value);
        }
    });
    return section;
}

Status check_in_grid(const Section& section, const grid::GridSpec& spec) {
    const auto& in_grid = section.in_grid;
    if (std::any_of(in_grid.begin(), in_grid.end(), [](auto in) { return in != 0; })) return {};
    const grid::GridProjection projection(spec);
    return fail(ErrorCode::bad_argument,
                "the section from {} to {} lies completely outside the grid, which reaches from {} "
                "in the southwest to {} in the northeast",
                place_text(section.line.from), place_text(section.line.to),
                place_text(projection.to_geo({-0.5, -0.5})),
                place_text(projection.to_geo({spec.nx - 0.5, spec.ny - 0.5})));
}

SectionPlace section_place(int width, int height, double scale, bool labels) {
    if (!labels) return {0, 0, width, height};
    const auto scaled = [&](double length) {
        return static_cast<int>(std::lround(length * scale));
    };
    const int left = scaled(44);
    const int top = scaled(26);
    return {left, top, std::max(1, width - left - scaled(16)),
            std::max(1, height - top - scaled(50))};
}

}  // namespace stormcellar::render

// Operations that return exact contents of cells: of the column at a place, and of the columns
// along a line.
#include <algorithm>
#include <cmath>

#include "stormcellar/grid/projection.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

constexpr std::int64_t most_profile_points = 1024;
constexpr std::int64_t usual_profile_points = 101;
constexpr std::size_t most_profile_cells = std::size_t{1} << 18;

struct GridColumn {
    int x = 0, y = 0;
};

// Returns the column of the grid at the place, or none outside the grid.
std::optional<GridColumn> column_at(const grid::GridProjection& projection,
                                    const grid::GridSpec& spec, grid::GeoPoint place) {
    const grid::ColumnPoint point = projection.to_column(place);
    const double x = std::floor(point.x + 0.5);
    const double y = std::floor(point.y + 0.5);
    const bool is_within_grid = x >= 0 && x < spec.nx && y >= 0 && y < spec.ny;  // false for NaN
    if (!is_within_grid) return std::nullopt;
    return GridColumn{static_cast<int>(x), static_cast<int>(y)};
}

// Returns the names of the states, from state 0 to the last state that the moment can have.
ApiJson state_names(level2::Moment moment) {
    ApiJson names = ApiJson::array();
    for (int state = 0; state <= static_cast<int>(grid::states_of(moment).back()); ++state)
        names.push_back(grid::cell_status_name(static_cast<grid::CellStatus>(state)));
    return names;
}

ApiJson value_json(const grid::BrickView& view, GridColumn column, int level) {
    if (view.status(column.x, column.y, level) != grid::CellStatus::value) return nullptr;
    return view.value(column.x, column.y, level);
}

ApiJson head_of(const OpenGrid& grid) {
    return {{"domain", grid.domain},
            {"moment", level2::moment_name(grid.moment)},
            {"units", level2::moment_units(grid.moment)},
            {"time", format_utc(grid.time)},
            {"id", grid.id},
            {"step", grid.file.view().quantization.step}};
}

// Returns points on the shortest way between two places, including both ends, and the length of the
// way.
std::vector<grid::GeoPoint> points_along(grid::GeoPoint from, grid::GeoPoint to, std::size_t count,
                                         double& length_m) {
    const grid::SiteFrame frame(from.latitude_deg, from.longitude_deg);
    const grid::PolarPoint end = frame.to_polar(to);
    length_m = end.arc_m;
    std::vector<grid::GeoPoint> points;
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(count - 1);
        points.push_back(frame.to_geo({end.azimuth_deg, end.arc_m * share}));
    }
    return points;
}

ApiJson profile_json(const OpenGrid& grid, const std::vector<grid::GeoPoint>& points,
                     double length_m) {
    const grid::BrickView view = grid.file.view();
    const grid::GridProjection projection(*view.spec);
    ApiJson json = head_of(grid);
    json["length_m"] = length_m;
    json["heights_m"] = view.spec->levels_m;
    json["state_names"] = state_names(grid.moment);
    json["points"] = ApiJson::array();
    for (std::size_t i = 0; i < points.size(); ++i) {
        ApiJson point{{"distance_m",
                       length_m * static_cast<double>(i) / static_cast<double>(points.size() - 1)},
                      {"latitude_deg", points[i].latitude_deg},
                      {"longitude_deg", points[i].longitude_deg}};
        const auto column = column_at(projection, *view.spec, points[i]);
        point["inside"] = column.has_value();
        if (column) {
            ApiJson states = ApiJson::array();
            ApiJson values = ApiJson::array();
            for (int level = 0; level < view.spec->nz(); ++level) {
                states.push_back(static_cast<int>(view.status(column->x, column->y, level)));
                values.push_back(value_json(view, *column, level));
            }
            point["states"] = std::move(states);
            point["values"] = std::move(values);
        }
        json["points"].push_back(std::move(point));
    }
    return json;
}

}  // namespace

Answer api_probe(const ApiCall& call) {
    const auto place = place_parameter(call, "at");
    if (!place) return json_error(place.error());
    const auto grid = find_grid(call);
    if (!grid) return grid.error();
    const grid::BrickView view = (*grid)->file.view();
    const grid::GridProjection projection(*view.spec);
    const auto column = column_at(projection, *view.spec, *place);
    if (!column) return json_error(400, "at: the place lies outside the grid");
    const grid::GeoPoint center =
        projection.to_geo({static_cast<double>(column->x), static_cast<double>(column->y)});
    ApiJson json = head_of(**grid);
    json["at"] = {place->latitude_deg, place->longitude_deg};
    json["column"] = {{"x", column->x},
                      {"y", column->y},
                      {"latitude_deg", center.latitude_deg},
                      {"longitude_deg", center.longitude_deg}};
    json["levels"] = ApiJson::array();
    for (int level = 0; level < view.spec->nz(); ++level) {
        json["levels"].push_back(
            {{"height_m", view.spec->levels_m[static_cast<std::size_t>(level)]},
             {"state", grid::cell_status_name(view.status(column->x, column->y, level))},
             {"value", value_json(view, *column, level)}});
    }
    if (Status whole = (*grid)->file.check_whole(); !whole) return json_error(whole.error());
    return json_answer(call.request, json);
}

Answer api_profile(const ApiCall& call) {
    const auto from = place_parameter(call, "from");
    if (!from) return json_error(from.error());
    const auto to = place_parameter(call, "to");
    if (!to) return json_error(to.error());
    const auto count = whole_parameter(call, "count", 2, most_profile_points, usual_profile_points);
    if (!count) return json_error(count.error());
    const auto grid = find_grid(call);
    if (!grid) return grid.error();
    const auto points = static_cast<std::size_t>(*count);
    if (points * (*grid)->file.view().spec->levels_m.size() > most_profile_cells) {
        return json_error(400, fmt::format("count: at most {} cells are sent, points times levels",
                                           most_profile_cells));
    }
    double length_m = 0;
    const auto along = points_along(*from, *to, points, length_m);
    const ApiJson json = profile_json(**grid, along, length_m);
    if (Status whole = (*grid)->file.check_whole(); !whole) return json_error(whole.error());
    return json_answer(call.request, json);
}

}  // namespace stormcellar::web

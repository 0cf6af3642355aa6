#include "stormcellar/export/cell_text.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "export/cell_values.h"

namespace stormcellar::cell_export {
namespace {

using nlohmann::ordered_json;
using retrieve::CellForecast;
using retrieve::CellSighting;
using retrieve::TrackedCell;
using retrieve::TrackedScan;

std::string dumped(const ordered_json& document) {
    return document.dump(1, ' ', true, ordered_json::error_handler_t::replace) + "\n";
}

ordered_json attributes_of(const TrackedCell& cell) {
    ordered_json json = {{"id", cell.id},
                         {"time", format_utc(cell.time)},
                         {"origin", retrieve::cell_origin_name(cell.origin)},
                         {"parents", cell.parents}};
    for (const CellValue& value : cell_values()) {
        if (const auto number = value.of(cell)) json[value.name] = rounded(*number, value.decimals);
    }
    json["top_is_at_least"] = cell.cell.top_is_at_least;
    return json;
}

ordered_json place_json(grid::GeoPoint place) {
    return {{"latitude_deg", rounded(place.latitude_deg, position_decimals)},
            {"longitude_deg", rounded(place.longitude_deg, position_decimals)}};
}

ordered_json cell_json(const TrackedCell& cell) {
    ordered_json json = attributes_of(cell);
    json["past"] = ordered_json::array();
    for (const CellSighting& sighting : cell.past) {
        ordered_json past = place_json(sighting.position);
        past["time"] = format_utc(sighting.time);
        json["past"].push_back(std::move(past));
    }
    json["forecasts"] = ordered_json::array();
    for (const CellForecast& forecast : cell.forecasts) {
        ordered_json ahead = place_json(forecast.position);
        ahead["minutes"] = forecast.minutes;
        ahead["time"] = format_utc(forecast.time);
        ahead["error_m"] = rounded(forecast.error_m, 0);
        json["forecasts"].push_back(std::move(ahead));
    }
    return json;
}

ordered_json coordinates(grid::GeoPoint place) {
    return ordered_json::array({rounded(place.longitude_deg, position_decimals),
                                rounded(place.latitude_deg, position_decimals)});
}

ordered_json feature(std::string_view type, ordered_json points, ordered_json properties) {
    return {{"type", "Feature"},
            {"geometry", {{"type", type}, {"coordinates", std::move(points)}}},
            {"properties", std::move(properties)}};
}

// Names the heights on which MESH depends, and the error of both heights that the range of MESH
// covers.
void add_freezing_levels(const TrackedScan& scan, ordered_json& json) {
    if (!scan.freezing) return;
    json["assumed_freezing_levels_m"] = {scan.freezing->zero_c_m, scan.freezing->minus_20_c_m};
    json["freezing_levels_error_m"] = retrieve::usual_level_error_m;
}

// Adds the features of a cell: a point, and the lines behind and ahead of it.
void add_features(const TrackedCell& cell, ordered_json& features) {
    ordered_json properties = {{"kind", "cell"}};
    properties.update(attributes_of(cell));
    features.push_back(feature("Point", coordinates(cell.cell.position), std::move(properties)));
    if (!cell.past.empty()) {
        ordered_json points = ordered_json::array(), times = ordered_json::array();
        for (const CellSighting& sighting : cell.past) {
            points.push_back(coordinates(sighting.position));
            times.push_back(format_utc(sighting.time));
        }
        points.push_back(coordinates(cell.cell.position));
        times.push_back(format_utc(cell.time));
        features.push_back(feature("LineString", std::move(points),
                                   {{"kind", "track"}, {"id", cell.id}, {"times", times}}));
    }
    if (cell.forecasts.empty()) return;
    ordered_json points = ordered_json::array({coordinates(cell.cell.position)});
    ordered_json minutes = ordered_json::array({0}), errors = ordered_json::array({0});
    for (const CellForecast& forecast : cell.forecasts) {
        points.push_back(coordinates(forecast.position));
        minutes.push_back(forecast.minutes);
        errors.push_back(static_cast<long>(rounded(forecast.error_m, 0)));
    }
    features.push_back(feature(
        "LineString", std::move(points),
        {{"kind", "forecast"}, {"id", cell.id}, {"minutes", minutes}, {"errors_m", errors}}));
}

std::string csv_head() {
    std::string head = "id,time,origin,parents";
    for (const CellValue& value : cell_values())
        head += fmt::format(",{}", value.name);
    head += ",top_is_at_least";
    for (const int minutes : retrieve::forecast_minutes)
        head += fmt::format(",latitude_{0}min_deg,longitude_{0}min_deg,error_{0}min_m", minutes);
    return head + "\r\n";
}

// Parents are separated by spaces. No field needs quotes: ids have no commas.
std::string csv_row(const TrackedCell& cell) {
    std::string row =
        fmt::format("{},{},{},{}", cell.id, format_utc(cell.time),
                    retrieve::cell_origin_name(cell.origin), fmt::join(cell.parents, " "));
    for (const CellValue& value : cell_values()) {
        const auto number = value.of(cell);
        row += number ? fmt::format(",{:.{}f}", rounded(*number, value.decimals), value.decimals)
                      : std::string(",");
    }
    row += cell.cell.top_is_at_least ? ",true" : ",false";
    for (const int minutes : retrieve::forecast_minutes) {
        const auto is_meant = [minutes](const CellForecast& f) { return f.minutes == minutes; };
        const auto forecast = std::ranges::find_if(cell.forecasts, is_meant);
        row += forecast == cell.forecasts.end()
                   ? std::string(",,,")
                   : fmt::format(",{:.5f},{:.5f},{:.0f}", forecast->position.latitude_deg,
                                 forecast->position.longitude_deg, forecast->error_m);
    }
    return row + "\r\n";
}

}  // namespace

std::string cells_json(const TrackedScan& scan) {
    ordered_json document = {{"area", scan.area}, {"time", format_utc(scan.time)}};
    add_freezing_levels(scan, document);
    document["cells"] = ordered_json::array();
    for (const TrackedCell& cell : scan.cells)
        document["cells"].push_back(cell_json(cell));
    return dumped(document);
}

std::string cells_geojson(const TrackedScan& scan) {
    ordered_json all = {{"type", "FeatureCollection"}};
    add_freezing_levels(scan, all);
    all["features"] = ordered_json::array();
    for (const TrackedCell& cell : scan.cells)
        add_features(cell, all["features"]);
    return dumped(all);
}

std::string cells_csv(std::span<const TrackedCell> cells) {
    std::string text = csv_head();
    for (const TrackedCell& cell : cells)
        text += csv_row(cell);
    return text;
}

}  // namespace stormcellar::cell_export

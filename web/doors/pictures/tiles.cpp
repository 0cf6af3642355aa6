#include "web/doors/pictures/tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"
#include "web/data/grids/text_answer.h"
#include "web/data/pictures/sweep_layer.h"
#include "web/doors/pictures/picture_answers.h"

namespace stormcellar::web {
namespace {

using TileJson = nlohmann::ordered_json;

constexpr std::size_t segments_of_a_tile = 7;  // tiles, domain, layer, time, z, x, y.png

std::optional<int> whole_below(std::string_view text, int end) {
    const auto number = parse_index(text);
    if (!number || *number >= static_cast<std::size_t>(end)) return std::nullopt;
    return static_cast<int>(*number);
}

Answer json_of_pictures(const Request& request, const TileJson& document) {
    return text_answer_to(request, "application/json",
                          document.dump(-1, ' ', false, TileJson::error_handler_t::replace) + "\n");
}

// Returns the options of a query as text, for links.
std::string query_text(const Fields& query) {
    std::string text;
    for (const auto& [name, value] : query) {
        text += text.empty() ? '?' : '&';
        text += encoded(name) + "=" + encoded(value);
    }
    return text;
}

// Returns the deepest zoom that is offered. A cell is then about eight pixels wide.
int useful_zoom(const grid::GridSpec& spec) {
    const double cell_m = spec.cell_height_m() / 8;
    const double at_equator_m = 2 * render::mercator_edge_m / 256;
    const double zoom = std::log2(at_equator_m / std::max(1.0, cell_m));
    return std::clamp(static_cast<int>(std::ceil(zoom)), 0, deepest_zoom);
}

TileJson bounds_of(const render::EarthBox& box) {
    // TileJSON has only longitudes from -180 to 180, so a box across the antimeridian must span all
    // of them.
    const bool crosses = box.west_deg < -180 || box.east_deg > 180;
    const auto held = [](double latitude) {
        return std::clamp(latitude, -most_latitude_deg, most_latitude_deg);
    };
    return TileJson::array({crosses ? -180.0 : box.west_deg, held(box.south_deg),
                            crosses ? 180.0 : box.east_deg, held(box.north_deg)});
}

TileJson layer_json(const Request& request, std::string_view domain, const MapProduct& layer) {
    return {{"layer", layer.name()},
            {"title", title_of(layer)},
            {"tilejson", fmt::format("{}/tiles/{}/{}/latest/tilejson.json", request.base, domain,
                                     layer.name())}};
}

Error no_such_tile() {
    return {ErrorCode::not_found, fmt::format("a tile is ZOOM/COLUMN/ROW.png, with zooms from 0 "
                                              "to {}",
                                              deepest_zoom)};
}

// A requested tile, with the grid and layer that it shows.
struct AskedTile {
    MapStyle style;
    TilePlace place;
};
Result<AskedTile> asked_tile(const Request& request, const std::vector<std::string_view>& path) {
    const auto place = tile_place_of(path[4], path[5], path[6]);
    if (!place) return tl::unexpected(no_such_tile());
    const auto layer = map_product_named(path[2]);
    if (!layer) return pass_on(layer);
    auto style = map_style(*layer, request.query, {});
    if (!style) return pass_on(style);
    return AskedTile{std::move(*style), *place};
}

}  // namespace

std::optional<TilePlace> tile_place_of(std::string_view zoom, std::string_view column,
                                       std::string_view file) {
    TilePlace place;
    if (!file.ends_with(".png")) return std::nullopt;
    file.remove_suffix(4);
    if (file.ends_with("@2x")) {
        place.side = 512;
        file.remove_suffix(3);
    }
    const auto deep = whole_below(zoom, deepest_zoom + 1);
    if (!deep) return std::nullopt;
    const auto x = whole_below(column, 1 << *deep);
    const auto y = whole_below(file, 1 << *deep);
    if (!x || !y) return std::nullopt;
    place.zoom = *deep;
    place.column = *x;
    place.row = *y;
    return place;
}

render::PlaneWindow window_of(const TilePlace& place) {
    const double side_m = 2 * render::mercator_edge_m / (1 << place.zoom);
    const double west = place.column * side_m - render::mercator_edge_m;
    const double north = render::mercator_edge_m - place.row * side_m;
    return {render::Plane::web_mercator,
            west,
            north - side_m,
            west + side_m,
            north,
            place.side,
            place.side};
}

std::optional<Answer> TilesDoor::answer_at_once(const Request& request) {
    const auto path = segments_of(request.path);
    if (path.size() != segments_of_a_tile) return std::nullopt;
    const auto asked = asked_tile(request, path);
    if (!asked) return std::nullopt;
    const MapProduct& layer = asked->style.layer;
    const auto time = time_of_grid(pictures_->grids(), path[1],
                                   pictures_->listed_moment(path[1], layer), path[3]);
    if (!time) return std::nullopt;
    const auto grid = pictures_->find_grid_if_open(path[1], layer, *time);
    if (!grid) return std::nullopt;
    return kept_map_answer(request, *pictures_,
                           {{{grid, asked->style}}, window_of(asked->place), {}},
                           max_age_of(path[3], *grid, layer.hours));
}

Answer TilesDoor::answer(const Request& request) {
    const auto path = segments_of(request.path);
    if (path.size() == 1) return index(request);
    if (path.size() == 5 && path[4] == "tilejson.json") return tilejson(request, path);
    if (path.size() == segments_of_a_tile) return tile(request, path);
    return sentence(404,
                    "There are /tiles, /tiles/DOMAIN/LAYER/TIME/tilejson.json and "
                    "/tiles/DOMAIN/LAYER/TIME/{z}/{x}/{y}.png here.");
}

Answer TilesDoor::index(const Request& request) {
    TileJson domains = TileJson::array();
    for (const std::string& domain : pictures_->grids().domains()) {
        if (cache::is_part(domain)) continue;
        TileJson layers = TileJson::array();
        const auto moments = pictures_->grids().moments(domain);
        for (const MapProduct& layer : pictures_->layers_of(domain))
            layers.push_back(layer_json(request, domain, layer));
        const bool has_sweeps = pictures_->sweeps() != nullptr && find_station(domain);
        for (const level2::Moment moment : moments)
            if (has_sweeps)
                layers.push_back(layer_json(request, domain, {render::Product::ppi, moment}));
        domains.push_back({{"domain", domain}, {"layers", std::move(layers)}});
    }
    return json_of_pictures(request, {{"options", parameters_for_help(is_of_layers)},
                                      {"options_of_ppi", parameters_for_help(is_of_sweep_layers)},
                                      {"domains", std::move(domains)}});
}

Answer TilesDoor::tilejson(const Request& request, const std::vector<std::string_view>& path) {
    if (is_sweep_layer(path[2])) {
        const auto shown = shown_sweep(request, path);
        if (!shown) return shown.error();
        const auto plane = pictures_->plane_of(*shown->layer.sweep);
        if (!plane) return picture_error(plane.error());
        return tilejson_of(request, path, shown->layer, *plane);
    }
    const auto layer = map_product_named(path[2]);
    if (!layer) return picture_error(layer.error());
    auto style = map_style(*layer, request.query, {});
    if (!style) return picture_error(style.error());
    const auto grid = grid_named(*pictures_, path[1], *layer, path[3]);
    if (!grid) return grid.error();
    return tilejson_of(request, path, {*grid, std::move(*style)}, (*grid)->file.description().spec);
}

Answer TilesDoor::tilejson_of(const Request& request, const std::vector<std::string_view>& path,
                              const PictureLayer& layer, const grid::GridSpec& spec) {
    const OpenGrid& grid = *layer.grid;
    const std::string name = layer.style.layer.name();
    const int deepest = useful_zoom(spec);
    const std::string tiles = fmt::format(
        "{}/tiles/{}/{}/{}/{{z}}/{{x}}/{{y}}.png{}", request.base, grid.domain, name,
        path[3] == "latest" ? "latest" : format_utc(grid.time), query_text(request.query));
    return json_of_pictures(
        request,
        {{"tilejson", "3.0.0"},
         {"name", fmt::format("{} {}", grid.domain, name)},
         {"description", fmt::format("{}, {}", title_of(layer.style.layer, layer.style.scene),
                                     format_utc(grid.time))},
         {"scheme", "xyz"},
         {"tiles", TileJson::array({tiles})},
         {"minzoom", 0},
         {"maxzoom", deepest},
         {"bounds", bounds_of(pictures_->box_of(grid.domain, spec))},
         {"center",
          {spec.center_longitude_deg, spec.center_latitude_deg, std::max(0, deepest - 5)}}});
}

Found<TilesDoor::ShownSweep> TilesDoor::shown_sweep(const Request& request,
                                                    const std::vector<std::string_view>& path) {
    if (pictures_->sweeps() == nullptr)
        return tl::unexpected(sentence(404, "This server draws no sweeps."));
    auto layer = sweep_layer(path[2], request.query);
    if (!layer) return tl::unexpected(picture_error(layer.error()));
    std::optional<UtcTime> exact;
    if (path[3] != "latest") {
        const auto time = parse_utc(path[3], now_utc());
        if (!time) return tl::unexpected(picture_error(time.error()));
        exact = *time;
    }
    const auto found = grid_of_sweep(pictures_->grids(), path[1], exact);
    if (!found && !exact) return tl::unexpected(sentence(404, "There is no grid in this domain."));
    const UtcTime time = exact.value_or(found ? found->time : UtcTime{});
    const auto grid = grid_named(pictures_->grids(), path[1],
                                 found ? found->moment : level2::Moment::ref, format_utc(time));
    if (!grid) return tl::unexpected(grid.error());
    auto sweep = sweep_of_grid(*pictures_->sweeps(), **grid, std::move(layer->frame));
    if (!sweep) return tl::unexpected(sweep.error());
    return ShownSweep{{*grid, std::move(layer->map), std::move(*sweep)},
                      max_age_of(path[3], **grid)};
}

Answer TilesDoor::tile(const Request& request, const std::vector<std::string_view>& path) {
    if (is_sweep_layer(path[2])) {
        const auto place = tile_place_of(path[4], path[5], path[6]);
        if (!place) return picture_error(no_such_tile());
        auto shown = shown_sweep(request, path);
        if (!shown) return shown.error();
        return map_answer(request, *pictures_, {{std::move(shown->layer)}, window_of(*place), {}},
                          shown->max_age);
    }
    auto asked = asked_tile(request, path);
    if (!asked) return picture_error(asked.error());
    const int hours = asked->style.layer.hours;
    const auto grid = grid_named(*pictures_, path[1], asked->style.layer, path[3]);
    if (!grid) return grid.error();
    return map_answer(request, *pictures_,
                      {{{*grid, std::move(asked->style)}}, window_of(asked->place), {}},
                      max_age_of(path[3], **grid, hours));
}

}  // namespace stormcellar::web

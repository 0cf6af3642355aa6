#include "web/doors/rainviewer/rainviewer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"
#include "web/data/grids/text_answer.h"
#include "web/doors/pictures/tiles.h"

namespace stormcellar::web {
namespace {

constexpr auto reflectivity = level2::Moment::ref;
constexpr std::chrono::hours listed{2};
constexpr std::chrono::minutes between_frames{10};
constexpr int least_gray = 1, most_gray = 127, gray_of_zero_dbz = 32;
constexpr int most_color = 8, color_of_classes = 6;

template <class Number>
std::optional<Number> number_in(std::string_view text) {
    Number number{};
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
    return number;
}

// Returns the table of COLOR 0: the gray level is the reflectivity in dBZ, rounded down, plus 32.
render::ColorTable gray_levels() {
    render::ColorTable table;
    table.name = "gray-levels";
    table.unit = "dBZ";
    for (int level = least_gray; level <= most_gray; ++level) {
        const auto gray = static_cast<std::uint8_t>(level);
        const render::Rgba8 color{gray, gray, gray, 255};
        table.stops.push_back({static_cast<float>(level - gray_of_zero_dbz), color, color});
    }
    table.end = static_cast<float>(most_gray - gray_of_zero_dbz + 1);
    table.extinction = {{table.lowest(), 1}};
    return table;
}

// Reads COLOR and OPTIONS.png.
Result<MapStyle> style_of(std::string_view color, std::string_view file) {
    const auto scheme = number_in<int>(color);
    if (!scheme || *scheme < 0 || *scheme > most_color)
        return fail(ErrorCode::not_found, "a color scheme is a number from 0 to {}", most_color);
    const bool is_options = file.size() == 7 && file[1] == '_' && file.ends_with(".png") &&
                            (file[0] == '0' || file[0] == '1') &&
                            (file[2] == '0' || file[2] == '1');
    if (!is_options)
        return fail(ErrorCode::not_found, "the options are SMOOTH_SNOW.png, each 0 or 1");
    const bool is_smooth = file[0] == '1' && *scheme != 0;
    auto style = map_style({render::Product::composite, reflectivity},
                           {{"colors", *scheme == color_of_classes ? "nws" : "smooth"},
                            {"smooth", is_smooth ? "cubic" : "none"}},
                           {});
    if (!style) return style;
    style->look = render::PlaneLook::echo;
    style->key += "\necho alone";
    if (*scheme == 0) {
        style->scene.colors = gray_levels();
        style->key += "\ngray levels";
    }
    return style;
}

Result<MapStyle> style_of_coverage() {
    auto style = map_style({render::Product::composite, reflectivity}, {}, {});
    if (!style) return style;
    style->look = render::PlaneLook::unseen;
    style->key += "\nunseen";
    return style;
}

// Reads SIZE, {z}, and {x} and {y} or a latitude and a longitude.
Result<render::PlaneWindow> window_named(std::string_view size, std::string_view zoom,
                                         std::string_view x, std::string_view y) {
    if (size != "256" && size != "512")
        return fail(ErrorCode::not_found, "a tile has 256 or 512 pixels");
    const std::string ending = size == "512" ? "@2x.png" : ".png";
    const bool is_place = x.find('.') != x.npos || y.find('.') != y.npos;
    const auto tile = is_place ? tile_place_of(zoom, "0", "0" + ending)
                               : tile_place_of(zoom, x, std::string(y) + ending);
    if (!tile)
        return fail(ErrorCode::not_found, "there is no such tile; the zooms are 0 to {}",
                    deepest_zoom);
    render::PlaneWindow window = window_of(*tile);
    if (!is_place) return window;
    const auto latitude = number_in<double>(x), longitude = number_in<double>(y);
    if (!latitude || !longitude || !(std::abs(*latitude) < most_latitude_deg) ||
        !(std::abs(*longitude) <= 180))
        return fail(ErrorCode::not_found, "there is no such latitude and longitude on this map");
    const double half_m = (window.east - window.west) / 2;
    const double east = *longitude * std::numbers::pi / 180 * render::mercator_radius_m;
    const double north = render::mercator_y_m(*latitude);
    window.west = east - half_m;
    window.east = east + half_m;
    window.south = north - half_m;
    window.north = north + half_m;
    return window;
}

struct AskedPicture {
    MapStyle style;
    render::PlaneWindow window;
};
// Reads "v2/radar/TIME/SIZE/z/x/y/COLOR/OPTIONS.png" or "v2/coverage/0/SIZE/z/x/y/0/0_0.png".
Result<AskedPicture> picture_named(const std::vector<std::string_view>& path) {
    if (path.size() != 9 || path[0] != "v2")
        return fail(ErrorCode::not_found,
                    "there are /public/weather-maps.json, "
                    "/v2/radar/TIME/SIZE/z/x/y/COLOR/SMOOTH_SNOW.png and "
                    "/v2/coverage/0/SIZE/z/x/y/0/0_0.png here");
    const auto window = window_named(path[3], path[4], path[5], path[6]);
    if (!window) return pass_on(window);
    auto style = path[1] == "coverage" ? style_of_coverage() : style_of(path[7], path[8]);
    if (!style) return pass_on(style);
    return AskedPicture{std::move(*style), *window};
}

}  // namespace

std::vector<UtcTime> frame_times(const std::vector<UtcTime>& times) {
    std::vector<UtcTime> frames;
    if (times.empty()) return frames;
    const auto slot = [](UtcTime time) {
        return std::chrono::floor<std::chrono::minutes>(time).time_since_epoch() / between_frames;
    };
    const UtcTime newest = newest_believed(times);
    for (const UtcTime time : times) {
        if (time < newest - listed || time > newest) continue;
        if (!frames.empty() && slot(frames.back()) == slot(time)) frames.pop_back();
        frames.push_back(time);
    }
    return frames;
}

std::string RainViewerDoor::usual_domain() const {
    const Grids& grids = pictures_->grids();
    std::string station;
    for (std::string& domain : grids.domains()) {
        if (cache::is_part(domain) || !grids.newest(domain, reflectivity)) continue;
        if (!find_station(domain)) return std::move(domain);
        if (station.empty()) station = std::move(domain);
    }
    return station;
}

RainViewerDoor::Asked RainViewerDoor::asked(const Request& request) const {
    Asked asked{.domain = {}, .prefix = {}, .path = segments_of(request.path)};
    if (asked.path.size() < 2 || asked.path[0] != "rainviewer") {
        asked.domain = usual_domain();
        return asked;
    }
    asked.domain = asked.path[1];
    asked.prefix = "/rainviewer/" + encoded(asked.domain);
    asked.path.erase(asked.path.begin(), asked.path.begin() + 2);
    return asked;
}

Answer RainViewerDoor::weather_maps(const Request& request, const Asked& asked) const {
    nlohmann::ordered_json past = nlohmann::ordered_json::array();
    for (const UtcTime time : frame_times(pictures_->grids().times(asked.domain, reflectivity))) {
        const auto seconds = std::chrono::floor<std::chrono::seconds>(time).time_since_epoch();
        past.push_back(
            {{"time", seconds.count()}, {"path", fmt::format("/v2/radar/{}", seconds.count())}});
    }
    const auto now = std::chrono::floor<std::chrono::seconds>(now_utc()).time_since_epoch();
    const auto none = nlohmann::ordered_json::array();
    const nlohmann::ordered_json maps = {
        {"version", "2.0"},
        {"generated", now.count()},
        {"host", request.base + asked.prefix},
        {"radar", {{"past", std::move(past)}, {"nowcast", none}}},
        {"satellite", {{"infrared", none}}},
    };
    return text_answer_to(request, "application/json", maps.dump() + "\n");
}

Result<UtcTime> RainViewerDoor::time_of(const Asked& asked) const {
    const Grids& grids = pictures_->grids();
    if (asked.path[1] == "coverage")
        return time_of_grid(grids, asked.domain, reflectivity, "latest");
    const auto seconds = number_in<std::int64_t>(asked.path[2]);
    const std::int64_t last =
        std::chrono::floor<std::chrono::seconds>(cache::last_possible_time).time_since_epoch() /
        std::chrono::seconds{1};
    if (!seconds || *seconds < 0 || *seconds > last)
        return fail(ErrorCode::not_found, "a time is a number of seconds since 1970");
    const UtcTime time{std::chrono::seconds{*seconds}};
    // The grids' times have milliseconds.
    const auto times =
        grids.times(asked.domain, reflectivity, time, time + std::chrono::milliseconds{999});
    return times.empty() ? time : times.back();
}

std::optional<Answer> RainViewerDoor::answer_at_once(const Request& request) {
    const Asked wanted = asked(request);
    auto picture = picture_named(wanted.path);
    if (!picture) return std::nullopt;
    const auto time = time_of(wanted);
    if (!time) return std::nullopt;
    const auto grid = pictures_->grids().find_if_open(wanted.domain, reflectivity, *time);
    if (!grid) return std::nullopt;
    const auto max_age = max_age_of("", *grid);
    return kept_map_answer(request, *pictures_,
                           {{{grid, std::move(picture->style)}}, picture->window, {}}, max_age);
}

Answer RainViewerDoor::answer(const Request& request) {
    const Asked wanted = asked(request);
    if (wanted.path.size() == 2 && wanted.path[0] == "public" &&
        wanted.path[1] == "weather-maps.json")
        return weather_maps(request, wanted);
    auto picture = picture_named(wanted.path);
    if (!picture) return picture_error(picture.error());
    const auto time = time_of(wanted);
    if (!time) return picture_error(time.error());
    const auto grid =
        grid_named(pictures_->grids(), wanted.domain, reflectivity, format_utc(*time));
    if (!grid) return grid.error();
    return map_answer(request, *pictures_,
                      {{{*grid, std::move(picture->style)}}, picture->window, {}},
                      max_age_of("", **grid));
}

}  // namespace stormcellar::web

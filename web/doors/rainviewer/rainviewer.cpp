#include "web/doors/rainviewer/rainviewer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
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

std::int64_t seconds_since_1970(UtcTime time) {
    return std::chrono::floor<std::chrono::seconds>(time).time_since_epoch().count();
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

// Reads COLOR, and OPTIONS in the form SMOOTH_SNOW.
Result<MapStyle> style_of(std::string_view color, std::string_view options) {
    const auto scheme = parse_number<int>(color);
    if (!scheme || *scheme < 0 || *scheme > most_color)
        return fail(ErrorCode::not_found, "a color scheme is a number from 0 to {}", most_color);
    constexpr std::array<std::string_view, 4> known{"0_0", "0_1", "1_0", "1_1"};
    if (std::ranges::find(known, options) == known.end())
        return fail(ErrorCode::not_found, "the options are two digits, SMOOTH_SNOW, each 0 or 1");
    const bool is_smooth = options[0] == '1' && *scheme != 0;
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
    const auto latitude = parse_number<double>(x), longitude = parse_number<double>(y);
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
    std::string_view ending;

    [[nodiscard]] MapPicture of(std::shared_ptr<const OpenGrid> grid) const {
        return {{{std::move(grid), style}}, window, {}, ending};
    }
};
// Reads "v2/radar/TIME/SIZE/z/x/y/COLOR/OPTIONS.png" or "v2/coverage/0/SIZE/z/x/y/0/0_0.png".
Result<AskedPicture> picture_named(const std::vector<std::string_view>& path) {
    const bool is_tile =
        path.size() == 9 && path[0] == "v2" && (path[1] == "radar" || path[1] == "coverage");
    if (!is_tile)
        return fail(ErrorCode::not_found,
                    "there are /public/weather-maps.json, /public/maps.json, "
                    "/v2/radar/TIME/SIZE/z/x/y/COLOR/SMOOTH_SNOW.png and "
                    "/v2/coverage/0/SIZE/z/x/y/0/0_0.png here");
    const std::size_t dot = std::min(path[8].find('.'), path[8].size());
    const std::string_view ending = path[8].substr(dot);
    if (ending != ".png" && ending != ".webp")
        return fail(ErrorCode::not_found, "a tile ends with .png or .webp");
    const auto window = window_named(path[3], path[4], path[5], path[6]);
    if (!window) return pass_on(window);
    auto style =
        path[1] == "coverage" ? style_of_coverage() : style_of(path[7], path[8].substr(0, dot));
    if (!style) return pass_on(style);
    return AskedPicture{std::move(*style), *window, ending == ".png" ? ".png" : ".webp"};
}

// Returns the time of a path for max_age_of(). The coverage is always that of the newest grid.
std::string_view time_text(const std::vector<std::string_view>& path) {
    return path[1] == "coverage" ? "latest" : path[2];
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

std::vector<std::int64_t> RainViewerDoor::frames_of(const Asked& asked) const {
    std::vector<std::int64_t> seconds;
    for (const UtcTime time : frame_times(pictures_->grids().times(asked.domain, reflectivity)))
        seconds.push_back(seconds_since_1970(time));
    return seconds;
}

Answer RainViewerDoor::legacy_maps(const Request& request, const Asked& asked) const {
    return text_answer_to(request, "application/json",
                          nlohmann::json(frames_of(asked)).dump() + "\n");
}

Answer RainViewerDoor::weather_maps(const Request& request, const Asked& asked) const {
    nlohmann::ordered_json past = nlohmann::ordered_json::array();
    for (const std::int64_t time : frames_of(asked))
        past.push_back({{"time", time}, {"path", fmt::format("/v2/radar/{}", time)}});
    const auto none = nlohmann::ordered_json::array();
    const nlohmann::ordered_json maps = {
        {"version", "2.0"},
        {"generated", seconds_since_1970(now_utc())},
        {"host", request.base + asked.prefix},
        {"radar", {{"past", std::move(past)}, {"nowcast", none}}},
        {"satellite", {{"infrared", none}}},
    };
    return text_answer_to(request, "application/json", maps.dump() + "\n");
}

Result<UtcTime> RainViewerDoor::time_of(const Asked& asked) const {
    const Grids& grids = pictures_->grids();
    if (time_text(asked.path) == "latest")
        return time_of_grid(grids, asked.domain, reflectivity, "latest");
    const auto seconds = parse_number<std::int64_t>(asked.path[2]);
    if (!seconds || *seconds < 0 || *seconds > seconds_since_1970(cache::last_possible_time))
        return fail(ErrorCode::not_found, "a time is a number of seconds since 1970");
    const UtcTime time{std::chrono::seconds{*seconds}};
    // The grids' times have milliseconds.
    const auto times =
        grids.times(asked.domain, reflectivity, time, time + std::chrono::milliseconds{999});
    return times.empty() ? time : times.back();
}

std::optional<Answer> RainViewerDoor::answer_at_once(const Request& request) {
    const Asked wanted = asked(request);
    const auto picture = picture_named(wanted.path);
    if (!picture) return std::nullopt;
    const auto time = time_of(wanted);
    if (!time) return std::nullopt;
    const auto grid = pictures_->grids().find_if_open(wanted.domain, reflectivity, *time);
    if (!grid) return std::nullopt;
    return kept_map_answer(request, *pictures_, picture->of(grid),
                           max_age_of(time_text(wanted.path), *grid));
}

Answer RainViewerDoor::answer(const Request& request) {
    const Asked wanted = asked(request);
    if (!wanted.prefix.empty() && !pictures_->grids().newest(wanted.domain, reflectivity))
        return sentence(404, "There is no grid of reflectivity in this domain.");
    if (wanted.path.size() == 2 && wanted.path[0] != "v2") {
        if (wanted.path[1] == "weather-maps.json") return weather_maps(request, wanted);
        if (wanted.path[1] == "maps.json") return legacy_maps(request, wanted);
    }
    const auto picture = picture_named(wanted.path);
    if (!picture) return picture_error(picture.error());
    const auto time = time_of(wanted);
    if (!time) return picture_error(time.error());
    const auto grid =
        grid_named(pictures_->grids(), wanted.domain, reflectivity, format_utc(*time));
    if (!grid) return grid.error();
    return map_answer(request, *pictures_, picture->of(*grid),
                      max_age_of(time_text(wanted.path), **grid));
}

}  // namespace stormcellar::web

#include "web/doors/frames.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "render/options/picture_options.h"
#include "web/data/picture_query.h"

namespace stormcellar::web {
namespace {

using nlohmann::ordered_json;

constexpr std::array<std::string_view, 1> read_by_door{"time"};
// A grid is mostly found among the newest ones, so that not all times of a domain are listed.
constexpr std::chrono::hours first_look{2};

// Returns the newest of the rising times at which there is a grid of every panel's moment.
std::optional<UtcTime> newest_in_common(const Grids& grids, std::string_view domain,
                                        const FrameStyle& style, std::optional<UtcTime> from,
                                        UtcTime to) {
    auto common = grids.times(domain, style.panels.front().moment, from, to);
    for (std::size_t i = 1; i < style.panels.size(); ++i) {
        const auto others = grids.times(domain, style.panels[i].moment, from, to);
        std::erase_if(common, [&](UtcTime time) {
            return !std::binary_search(others.begin(), others.end(), time);
        });
    }
    if (common.empty()) return std::nullopt;
    return common.back();
}

std::string moments_of_panels(const FrameStyle& style) {
    std::string names;
    for (const render::PanelScene& panel : style.panels)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", level2::moment_name(panel.moment));
    return names;
}

Answer no_grid_to_draw(const Grids& grids, std::string_view domain, const FrameStyle& style,
                       std::optional<UtcTime> exact) {
    const std::string what =
        fmt::format("of {} in '{}'", moments_of_panels(style), printable(domain.substr(0, 80)));
    if (exact && grids.was_evicted(domain, style.panels.front().moment, *exact))
        return sentence(410, fmt::format("The grid {} was evicted from the cache.", what));
    return sentence(404, exact ? fmt::format("There is no grid {} at or before this time.", what)
                               : fmt::format("There is no grid {}.", what));
}

ordered_json json_of_parameter(const render::PictureOption& row) {
    std::string help = render::help_of(row);
    for (std::size_t at = help.find("--"); at != std::string::npos; at = help.find("--", at))
        help.erase(at, 2);
    ordered_json json = {{"name", render::parameter_of(row)}, {"help", std::move(help)}};
    const std::string products = row.used_by.text();
    if (!products.empty()) json["products"] = products;
    return json;
}

}  // namespace

Found<FramesDoor::Asked> FramesDoor::asked(const Request& request) const {
    const auto path = segments_of(request.path);
    if (path.size() != 2 || request.path.ends_with('/')) {
        return tl::unexpected(
            sentence(404, "There are /frames and /frames/DOMAIN.png?time=TIME&product=NAME here."));
    }
    const std::string_view name = path[1];
    auto style = frame_style(name, request.query, read_by_door);
    if (!style) return tl::unexpected(picture_error(style.error()));
    Asked asked{std::string(name.substr(0, name.rfind('.'))), std::move(*style), {}, {}};
    if (request.parameters("time").size() > 1)
        return tl::unexpected(sentence(400, "time is given more than once."));
    const std::string_view text = request.parameter("time").value_or("latest");
    std::optional<UtcTime> exact;
    std::optional<UtcTime> until;
    if (text == "latest") {
        until = grids_->newest(asked.domain, asked.style.panels.front().moment);
    } else {
        const auto time = parse_utc(text, now_utc());
        if (!time) return tl::unexpected(sentence(400, "time: " + time.error().message));
        exact = until = *time;
    }
    std::optional<UtcTime> found;
    if (until) {
        found = newest_in_common(*grids_, asked.domain, asked.style, *until - first_look, *until);
        if (!found) found = newest_in_common(*grids_, asked.domain, asked.style, {}, *until);
    }
    const bool is_evicted =
        exact && found != exact &&
        grids_->was_evicted(asked.domain, asked.style.panels.front().moment, *exact);
    if (!found || is_evicted)
        return tl::unexpected(no_grid_to_draw(*grids_, asked.domain, asked.style, exact));
    asked.time = *found;
    if (exact == found) asked.max_age = max_age_of("");
    return asked;
}

std::optional<Answer> FramesDoor::answer_at_once(const Request& request) {
    auto what = asked(request);
    if (!what)
        return segments_of(request.path).size() == 1 ? std::nullopt : std::optional(what.error());
    FramePicture picture{what->domain, {}, std::move(what->style)};
    for (const render::PanelScene& panel : picture.style.panels) {
        auto grid = grids_->find_if_open(what->domain, panel.moment, what->time);
        if (!grid) return std::nullopt;
        picture.grids.push_back(std::move(grid));
    }
    if (auto same = unchanged_answer(request, picture.etag(), what->max_age)) return same;
    const auto kept = pictures_->find(picture);
    if (!kept) return std::nullopt;
    return picture_answer(request, *kept, what->max_age);
}

Answer FramesDoor::answer(const Request& request) {
    if (segments_of(request.path).size() == 1) return index(request);
    auto what = asked(request);
    if (!what) return what.error();
    FramePicture picture{what->domain, {}, std::move(what->style)};
    for (const render::PanelScene& panel : picture.style.panels) {
        auto grid = grid_named(*grids_, what->domain, panel.moment, format_utc(what->time));
        if (!grid) return grid.error();
        picture.grids.push_back(std::move(*grid));
    }
    if (auto same = unchanged_answer(request, picture.etag(), what->max_age)) return *same;
    const auto drawn = pictures_->find_or_draw(picture);
    if (!drawn) return picture_error(drawn.error());
    return picture_answer(request, *drawn, what->max_age);
}

Answer FramesDoor::index(const Request& request) const {
    ordered_json formats = ordered_json::array();
    for (const render::StillFormat& format : render::still_formats()) {
        formats.push_back({{"name", format.name},
                           {"ending", format.endings.front()},
                           {"media_type", format.media_type},
                           {"maps_only", format.encode_map != nullptr}});
    }
    ordered_json parameters = ordered_json::array();
    for (const render::PictureOption& row : render::picture_options())
        if (is_of_frames(row)) parameters.push_back(json_of_parameter(row));
    ordered_json domains = ordered_json::array();
    for (const std::string& domain : grids_->domains())
        domains.push_back({{"domain", domain},
                           {"picture", fmt::format("{}/frames/{}.png", request.base, domain)}});
    const ordered_json document = {{"domains", std::move(domains)},
                                   {"formats", std::move(formats)},
                                   {"parameters", std::move(parameters)}};
    Answer answer =
        text_answer(200, "application/json",
                    document.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
    answer.with("Cache-Control", "no-cache");
    return answer;
}

}  // namespace stormcellar::web

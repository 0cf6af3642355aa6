#include "web/doors/pictures/frames.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "render/options/picture_options.h"
#include "stormcellar/render/product.h"
#include "web/data/grids/text_answer.h"
#include "web/data/pictures/picture_query.h"
#include "web/data/storms/marked_cells.h"

namespace stormcellar::web {
namespace {

using nlohmann::ordered_json;

constexpr std::array<std::string_view, 1> read_by_door{"time"};
// Look first among grids this new, which usually have the answer, before listing all times.
constexpr std::chrono::hours first_look{2};

// Returns the newest of these ascending times at which every moment has a grid.
std::optional<UtcTime> newest_in_common(const Grids& grids, std::string_view domain,
                                        const std::vector<level2::Moment>& moments,
                                        std::optional<UtcTime> from, UtcTime to) {
    auto common = grids.times(domain, moments.front(), from, to);
    for (std::size_t i = 1; i < moments.size(); ++i) {
        const auto others = grids.times(domain, moments[i], from, to);
        std::erase_if(common, [&](UtcTime time) {
            return !std::binary_search(others.begin(), others.end(), time);
        });
    }
    if (common.empty()) return std::nullopt;
    return common.back();
}
std::optional<UtcTime> newest_in_common(const Grids& grids, std::string_view domain,
                                        const std::vector<level2::Moment>& moments, UtcTime until) {
    const auto found = newest_in_common(grids, domain, moments, until - first_look, until);
    return found ? found : newest_in_common(grids, domain, moments, {}, until);
}

std::vector<level2::Moment> moments_of_panels(const FrameStyle& style) {
    std::vector<level2::Moment> moments;
    for (const render::PanelScene& panel : style.panels)
        moments.push_back(panel.moment);
    return moments;
}

// Returns the time of the domain's newest grid of any of these moments.
std::optional<UtcTime> newest_of_any(const Grids& grids, std::string_view domain,
                                     const std::vector<level2::Moment>& moments) {
    std::optional<UtcTime> newest;
    for (const level2::Moment moment : moments)
        newest = std::max(newest, grids.newest(domain, moment));
    return newest;
}

Answer no_grid_to_draw(std::string_view domain, const std::vector<level2::Moment>& moments,
                       bool is_evicted, bool has_time) {
    std::string what = "of ";
    for (const level2::Moment moment : moments)
        what += fmt::format("{}{}", what.size() > 3 ? ", " : "", level2::moment_name(moment));
    what = fmt::format("{}in '{}'", moments.empty() ? "" : what + " ",
                       printable(domain.substr(0, 80)));
    if (is_evicted)
        return sentence(410, fmt::format("The grid {} was evicted from the cache.", what));
    return sentence(404, has_time ? fmt::format("There is no grid {} at or before this time.", what)
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
    Asked asked{std::string(name.substr(0, name.rfind('.'))), std::move(*style), {}, {}, {}};
    asked.moments = asked.is_of_sweep() ? grids_->moments(asked.domain)
                    : asked.style.hours > 0
                        ? std::vector{RainTotals::listed_moment(*grids_, asked.domain)}
                        : moments_of_panels(asked.style);
    if (request.parameters("time").size() > 1)
        return tl::unexpected(sentence(400, "time is given more than once."));
    const std::string_view text = request.parameter("time").value_or("latest");
    std::optional<UtcTime> exact;
    std::optional<UtcTime> until;
    if (text == "latest") {
        until = newest_of_any(*grids_, asked.domain, asked.moments);
    } else {
        const auto time = parse_utc(text, now_utc());
        if (!time) return tl::unexpected(sentence(400, "time: " + time.error().message));
        exact = until = *time;
    }
    const bool is_found = until && find_grids(asked, *until);
    const bool is_evicted = exact && !(is_found && asked.time == *exact) &&
                            std::ranges::any_of(asked.moments, [&](level2::Moment moment) {
                                return grids_->was_evicted(asked.domain, moment, *exact);
                            });
    if (!is_found || is_evicted) {
        return tl::unexpected(
            no_grid_to_draw(asked.domain, asked.moments, is_evicted, exact.has_value()));
    }
    if (exact == asked.time && asked.style.hours == 0) asked.max_age = answer_holds_for;
    return asked;
}

bool FramesDoor::Asked::is_of_sweep() const {
    return render::facts_of(style.panels.front().scene.product).is_of_sweep;
}

bool FramesDoor::find_grids(Asked& asked, UtcTime until) const {
    if (!asked.is_of_sweep()) {
        const auto time = newest_in_common(*grids_, asked.domain, asked.moments, until);
        if (time) asked.time = *time;
        return time.has_value();
    }
    const auto newest = grid_of_sweep(*grids_, asked.domain, until);
    if (!newest) return false;
    asked.time = newest->time;
    asked.moments = {newest->moment};
    return true;
}

std::optional<Answer> FramesDoor::answer_at_once(const Request& request) {
    auto what = asked(request);
    if (!what)
        return segments_of(request.path).size() == 1 ? std::nullopt : std::optional(what.error());
    if (what->is_of_sweep() || render::marks_cells(what->style.options)) return std::nullopt;
    FramePicture picture{what->domain, {}, std::move(what->style)};
    const int hours = picture.style.hours;
    for (const render::PanelScene& panel : picture.style.panels) {
        auto grid = hours > 0 ? rain_->find_if_kept(what->domain, hours, what->time)
                              : grids_->find_if_open(what->domain, panel.moment, what->time);
        if (!grid) return std::nullopt;
        if (grid->may_change()) what->max_age.reset();
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
    if (const Status found = find_cells(*what); !found) return picture_error(found.error());
    if (what->is_of_sweep()) return of_sweep(request, std::move(*what));
    const auto picture = picture_of(*what);
    if (!picture) return picture.error();
    if (auto same = unchanged_answer(request, picture->etag(), what->max_age)) return *same;
    const auto drawn = pictures_->find_or_draw(*picture);
    if (!drawn) return picture_error(drawn.error());
    return picture_answer(request, *drawn, what->max_age);
}

Status FramesDoor::find_cells(Asked& asked) const {
    FrameStyle& style = asked.style;
    if (!render::marks_cells(style.options)) return {};
    asked.max_age.reset();  // an older grid, through which cells were followed, may be made again
    auto marked =
        marked_cells(*scans_, asked.domain, asked.time,
                     render::chosen_freezing_levels(style.options, style.panels.front().scene));
    if (!marked) return pass_on(marked);
    style.cells = std::move(marked->overlay);
    style.key += marked->key;
    return {};
}

Found<FramePicture> FramesDoor::picture_of(Asked& asked) const {
    FramePicture picture{asked.domain, {}, std::move(asked.style)};
    const std::string time = format_utc(asked.time);
    const int hours = picture.style.hours;
    for (const render::PanelScene& panel : picture.style.panels) {
        auto grid = hours > 0 ? total_named(*grids_, *rain_, asked.domain, hours, time)
                              : grid_named(*grids_, asked.domain, panel.moment, time);
        if (!grid) return tl::unexpected(grid.error());
        if ((*grid)->may_change()) asked.max_age.reset();
        picture.grids.push_back(std::move(*grid));
    }
    return picture;
}

Answer FramesDoor::of_sweep(const Request& request, Asked what) {
    const auto grid = grid_named(*grids_, what.domain, what.moments.front(), format_utc(what.time));
    if (!grid) return grid.error();
    if ((*grid)->may_change()) what.max_age.reset();
    const auto sweep = sweep_of_grid(*sweeps_, **grid, std::move(what.style));
    if (!sweep) return sweep.error();
    if (auto same = unchanged_answer(request, sweep->etag(), what.max_age)) return *same;
    const auto drawn = sweeps_->find_or_draw(*sweep);
    if (!drawn) return picture_error(drawn.error());
    return picture_answer(request, *drawn, what.max_age);
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
    return text_answer_to(
        request, "application/json",
        document.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace stormcellar::web

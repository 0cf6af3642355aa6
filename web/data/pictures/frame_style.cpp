#include "web/data/pictures/frame_style.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "render/frame/picture_metadata.h"
#include "render/options/still_frame.h"
#include "stormcellar/render/panels.h"
#include "web/data/pictures/picture_query.h"
#include "web/data/storms/rain_totals.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view panels_parameter = "panels", tiff_parameter = "geotiff",
                           hours_parameter = "hours";

std::string parameter_text(const Fields& query, std::string_view wanted) {
    for (const auto& [name, text] : query)
        if (name == wanted) return text;
    return {};
}

// Reads a parameter that the table of options does not have.
Status take_more(const Fields& query, FrameStyle& style) {
    for (const std::string_view name : {panels_parameter, tiff_parameter, hours_parameter}) {
        const auto count = std::ranges::count(
            query, name, [](const auto& one) -> std::string_view { return one.first; });
        if (count > 1) return fail(ErrorCode::bad_argument, "{} is given more than once", name);
        if (count > 0) style.key += fmt::format("\n{}={}", name, parameter_text(query, name));
    }
    const std::string hours = parameter_text(query, hours_parameter);
    const auto* const end = hours.data() + hours.size();
    const auto [rest, error] = std::from_chars(hours.data(), end, style.hours);
    const bool is_length = error == std::errc{} && rest == end && style.hours >= 1 &&
                           style.hours <= RainTotals::most_hours;
    if (!hours.empty() && !is_length)
        return fail(ErrorCode::bad_argument, "{} is a whole number from 1 to {}", hours_parameter,
                    RainTotals::most_hours);
    const std::string tiff = parameter_text(query, tiff_parameter);
    if (tiff.empty()) return {};
    const auto content = render::tiff_content_from_name(tiff);
    if (!content || style.format->name != "GeoTIFF") {
        return fail(ErrorCode::bad_argument,
                    "{} is values, states or colors, and for a GeoTIFF (.tif) alone",
                    tiff_parameter);
    }
    style.tiff = *content;
    return {};
}

Status check_size_of_frame(const render::Scene& scene) {
    const std::int64_t pixels = std::int64_t{scene.width} * scene.height;
    if (pixels > most_frame_pixels) {
        return fail(ErrorCode::bad_argument,
                    "a picture of {} by {} pixels is too large: {} pixels are drawn at most",
                    scene.width, scene.height, most_frame_pixels);
    }
    const bool is_volume = render::view_of(scene.product) == render::View::volume;
    if (is_volume && pixels * scene.slices > most_frame_samples) {
        return fail(ErrorCode::bad_argument,
                    "{} slices of {} pixels are too many: pixels times slices may be {} at most",
                    scene.slices, pixels, most_frame_samples);
    }
    return {};
}

// Checks that a product over time is a rain total of some hours, which fills the whole picture.
Status check_over_time(const FrameStyle& style, render::Product product) {
    const bool is_sum = render::facts_of(product).is_sum && !style.has_panels;
    if (style.hours > 0 && !is_sum)
        return fail(ErrorCode::bad_argument, "{} is the length of a rain-total", hours_parameter);
    if (style.hours > 0) return {};
    if (is_sum)
        return fail(ErrorCode::bad_argument, "a rain-total needs {}, as in {}=3", hours_parameter,
                    hours_parameter);
    return render::check_single_grid(product);
}

// Returns the panels of the picture. If there is only one, it fills the whole picture.
Result<std::vector<render::PanelScene>> panels_of_frame(const FrameStyle& style,
                                                        const std::string& list) {
    if (style.has_panels) {
        auto panels = render::panel_scenes(list, style.options, render::scene_of);
        if (!panels) return panels;
        if (Status fits = check_over_time(style, panels->front().scene.product); !fits)
            return pass_on(fits);
        return panels;
    }
    auto scene = render::scene_of(style.options);
    if (!scene) return pass_on(scene);
    if (Status fits = render::check_stored_derivation(style.options, scene->product); !fits)
        return pass_on(fits);
    if (Status fits = check_over_time(style, scene->product); !fits) return pass_on(fits);
    const level2::Moment moment = scene->moment;
    return std::vector<render::PanelScene>{{moment, std::move(*scene)}};
}

Result<std::vector<std::byte>> draw_one(const std::string& domain, const FrameStyle& style,
                                        const DrawnPanel& panel, int threads) {
    const render::Overlays overlays{.cells = style.cells.get()};
    const render::StillSource source{domain,        panel.view, *panel.description,
                                     style.options, false,      overlays};
    render::Scene scene = style.panels.front().scene;
    if (Status fitted = render::fit_to_grid(source, scene); !fitted) return pass_on(fitted);
    return render::encode_still(source, scene,
                                {.format = *style.format,
                                 .tiff = style.tiff,
                                 .error = {},
                                 .threads = threads,
                                 .drawn = {}});
}

Result<std::vector<std::byte>> draw_several(const std::string& domain, const FrameStyle& style,
                                            std::span<const DrawnPanel> drawn, int threads) {
    std::vector<render::Panel> panels;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const render::StillSource source{domain, drawn[i].view, *drawn[i].description,
                                         style.options, false};
        panels.push_back({drawn[i].view, render::facts_of_still(source), style.panels[i].scene});
    }
    const auto image = render::render_panels(panels, threads);
    if (!image) return pass_on(image);
    const cache::GridDescription& first = *drawn.front().description;
    const render::StillOptions still{
        .metadata = render::metadata_of({domain, first.time, first.time, std::nullopt, {}, {}},
                                        first, style.panels.front().scene)};
    return style.format->encode_picture(*image, still);
}

}  // namespace

Result<FrameStyle> frame_style(std::string_view file_name, const Fields& query,
                               std::span<const std::string_view> others) {
    FrameStyle style;
    style.format = render::still_format_of(file_name);
    if (style.format == nullptr) {
        return fail(ErrorCode::not_found, "the name of a picture ends as its format: {}",
                    render::known_still_formats());
    }
    std::vector<std::string_view> read_here(others.begin(), others.end());
    read_here.insert(read_here.end(), {panels_parameter, tiff_parameter, hours_parameter});
    auto read = picture_query(query, is_of_frames, read_here);
    if (!read) return pass_on(read);
    style.options = std::move(read->options);
    if (style.options.time_zone.empty()) style.options.time_zone = "UTC";
    style.key = fmt::format("{}\n{}", style.format->name, read->key);
    if (Status taken = take_more(query, style); !taken) return pass_on(taken);
    const std::string list = parameter_text(query, panels_parameter);
    style.has_panels = !list.empty();
    if (style.has_panels && style.format->encode_picture == nullptr) {
        return fail(ErrorCode::bad_argument,
                    "panels make a picture; GeoTIFF, netCDF and KMZ hold one map");
    }
    const bool may_mark = !style.has_panels && style.format->encode_map == nullptr;
    if (render::marks_cells(style.options) && !may_mark) {
        return fail(ErrorCode::bad_argument,
                    "an overlay is for a picture of one moment, not for panels or for data");
    }
    auto panels = panels_of_frame(style, list);
    if (!panels) return pass_on(panels);
    style.panels = std::move(*panels);
    if (Status fits = check_size_of_frame(style.panels.front().scene); !fits) return pass_on(fits);
    return style;
}

Result<Kept> draw_frame(const std::string& domain, const FrameStyle& style,
                        std::span<const DrawnPanel> panels, std::string etag, int threads) {
    const auto bytes = style.has_panels ? draw_several(domain, style, panels, threads)
                                        : draw_one(domain, style, panels.front(), threads);
    if (!bytes) return pass_on(bytes);
    std::string text(bytes->size(), '\0');
    if (!bytes->empty()) std::memcpy(text.data(), bytes->data(), bytes->size());
    return Kept{text_of(std::move(text)), std::move(etag), std::string(style.format->media_type)};
}

}  // namespace stormcellar::web

#include "render/map/labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/ranges.h>

#include "render/map/base_map.h"
#include "render/map/legend_layout.h"
#include "render/products/ground.h"
#include "render/products/smooth_field.h"
#include "render/view/length_text.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {
namespace {

constexpr double margin = 10;

std::string direction_name(double azimuth_deg) {
    static constexpr std::array<const char*, 16> names = {"N",  "NNE", "NE", "ENE", "E",  "ESE",
                                                          "SE", "SSE", "S",  "SSW", "SW", "WSW",
                                                          "W",  "WNW", "NW", "NNW"};
    const double turn = azimuth_deg - 360 * std::floor(azimuth_deg / 360);
    return names[static_cast<std::size_t>(std::lround(turn / 22.5)) % names.size()];
}

// Returns true if the name of the domain is a list of many sites, as in "KBGM+KCCX".
bool is_long_list_of_sites(const FrameFacts& facts) {
    constexpr std::size_t most_named = 3;
    const auto between = static_cast<std::size_t>(std::ranges::count(facts.domain, '+'));
    return facts.sites.size() > most_named && between + 1 == facts.sites.size();
}

std::string title_of(const FrameFacts& facts) {
    if (is_long_list_of_sites(facts)) return fmt::format("Mosaic of {} sites", facts.sites.size());
    if (facts.sites.size() != 1) {
        return facts.sites.empty()
                   ? facts.domain
                   : fmt::format("{}  ({} sites)", facts.domain, facts.sites.size());
    }
    const std::string& icao = facts.sites.front().icao;
    std::string title = icao;
    if (const auto station = find_station(icao)) {
        title += fmt::format("  {}, {}", station->name, station->state);
    }
    // In a mosaic, the domain with one site's data is named NAME.ICAO.
    if (facts.domain.ends_with("." + icao)) {
        const std::string name = facts.domain.substr(0, facts.domain.size() - icao.size() - 1);
        return fmt::format("{}  ({})", title, name);
    }
    if (facts.domain != icao) title = fmt::format("{}  ({})", facts.domain, title);
    return title;
}

// Returns the kinds of light as text, such as "gradient, shadow".
std::string light_text(const Light& light) {
    std::string text;
    for (const char letter : light_names(light))
        text += letter == ',' ? std::string(", ") : std::string(1, letter);
    return text;
}

std::string view_text(const Scene& scene) {
    const Camera camera = aimed(scene.camera, scene.vertical_exaggeration, scene.curved_earth);
    const double tilt = std::round(camera.tilt_deg);
    std::string text = tilt == 0 ? "Seen from above"
                                 : fmt::format("Seen from {}, {:g}\u00B0 from the vertical",
                                               direction_name(camera.azimuth_deg), tilt);
    text += fmt::format("  \u00B7  vertical \u00D7{:g}", scene.vertical_exaggeration);
    if (scene.light.any()) text += fmt::format("  \u00B7  lit ({})", light_text(scene.light));
    return text;
}

std::vector<std::string> warnings_of(const FrameFacts& facts) {
    std::vector<std::string> warnings;
    if (!facts.nowcast.empty()) warnings.push_back(facts.nowcast);
    if (facts.partial) warnings.emplace_back("partial volume");
    for (const std::string& machine : facts.left_out)
        warnings.push_back("without " + machine);
    warnings.insert(warnings.end(), facts.radar_troubles.begin(), facts.radar_troubles.end());
    return warnings;
}

// Returns the text that is written below the time.
std::string beside_time(const FrameFacts& facts) {
    if (!facts.interpolated) return facts.local_time;
    return (facts.local_time.empty() ? "" : facts.local_time + "  \u00B7  ") + "interpolated";
}

std::string view_line(const Scene& scene, const FrameFacts& facts, double ring_spacing_m) {
    std::string text;
    switch (view_of(scene.product)) {
        case View::volume:
            text = view_text(scene);
            break;
        case View::map:
            text = "Map, north up";
            if (is_smoothed(scene)) text += "  \u00B7  smoothed";
            break;
        case View::section:
            return "Vertical section from A to B";
    }
    if (facts.sites.size() == 1) {
        text += "  \u00B7  range rings every " + distance_text(ring_spacing_m, scene.units);
    }
    return text;
}

// Places the product and the warnings on one line, so that nothing moves from frame to frame of a
// loop. The line ends `room` pixels to the right of `left`. Short warnings take only the width that
// they need, and long warnings take at most four tenths of the line.
void put_product(LabelBuilder& builder, const HeaderTexts& texts, double left, double baseline,
                 double room, double size) {
    const double gap = builder.scaled(14);
    const LabelStyle warning{size, true, builder.shades().warning_text};
    const double for_warnings =
        texts.warnings.empty()
            ? 0
            : std::min(gap + std::ceil(builder.width_of(texts.warnings, warning)), 0.4 * room);
    const double width =
        builder.put(texts.product, left, baseline, room - for_warnings, builder.quiet(size));
    builder.put(texts.warnings, left + width + gap, baseline, room - width - gap, warning);
}

// Takes room for the small map of a section. In a wide picture the room is taken from the colors at
// the right, in a square picture from the colors below, and in a tall picture from the section
// itself, below the title.
void make_room_for_inset(const PictureSpace& space, const LabelBuilder& builder,
                         LabelLayout& layout, Rect& colors) {
    const double gap = std::round(builder.scaled(8));
    switch (space.shape) {
        case PictureShape::wide: {
            const double side = std::round(colors.width - builder.scaled(12 + margin));
            if (side > 0.45 * colors.height) return;
            layout.inset =
                Rect{std::round(colors.x + builder.scaled(12)), std::round(colors.y), side, side};
            colors.y += side + gap;
            colors.height -= side + gap;
            return;
        }
        case PictureShape::square: {
            const double side = std::round(builder.scaled(116));
            layout.height -= static_cast<int>(side - colors.height);
            colors.y -= side - colors.height;
            layout.inset = Rect{colors.x, colors.y, side, side};
            colors.x += side + gap;
            colors.width -= side + gap;
            return;
        }
        case PictureShape::tall:
            break;
    }
    const double height = std::round(0.36 * layout.height);
    layout.inset =
        Rect{0, static_cast<double>(layout.top), static_cast<double>(layout.width), height};
    layout.top += static_cast<int>(height + gap);
    layout.height -= static_cast<int>(height + gap);
}

Status check_room(const Scene& scene) {
    if (scene.width >= smallest_labelled_width && scene.height >= smallest_labelled_height) {
        return {};
    }
    return fail(ErrorCode::bad_argument,
                "labels need a picture of at least {} by {} pixels, not {} by {}; leave them out "
                "or draw a larger picture",
                smallest_labelled_width, smallest_labelled_height, scene.width, scene.height);
}

}  // namespace

std::string duration_text(std::chrono::seconds duration) {
    const auto seconds = duration.count();
    if (seconds < 60) return fmt::format("{} s", seconds);
    return fmt::format("{} min {} s", seconds / 60, seconds % 60);
}

std::string product_line(const Scene& scene, const FrameFacts& facts) {
    std::string line = product_title(scene);
    if (facts_of(scene.product).layer && facts.sites.size() > 1)
        line += fmt::format(", the lowest of {}", facts.sites.size());
    if (facts.storm_motion && scene.moment == level2::Moment::srv)
        line += ", " + motion_text(*facts.storm_motion, scene.units);
    if (!facts.dealiasing.empty()) line += ", dealiasing " + facts.dealiasing;
    if (facts.since) {
        const std::string since = format_utc(*facts.since);
        line += fmt::format(", since {} {} UTC", since.substr(0, 10), since.substr(11, 5));
    }
    if (!facts.rain.empty()) line += ", " + facts.rain;
    if (!facts.quality.empty()) line += ", " + facts.quality;
    return line;
}

HeaderTexts header_of(const FrameFacts& facts, const std::string& product) {
    const std::string time = format_utc(std::chrono::floor<std::chrono::seconds>(facts.time));
    return {.title = title_of(facts),
            .product = product,
            .time = time.substr(0, 10) + " " + time.substr(11, 8) + " UTC",
            .local_time = beside_time(facts),
            .warnings = fmt::format("{}", fmt::join(warnings_of(facts), "  \u00B7  "))};
}

void lay_out_header(LabelBuilder& builder, PictureShape shape, double width,
                    const HeaderTexts& texts) {
    const double left = builder.scaled(margin);
    const double right = width - left;
    const double gap = builder.scaled(14);
    if (shape == PictureShape::tall) {
        const double room = right - left;
        builder.put(texts.title, left, builder.scaled(23), room, builder.strong(17));
        put_product(builder, texts, left, builder.scaled(41), room, 11.5);
        const double time =
            builder.put(texts.time, left, builder.scaled(58), 0.6 * room, builder.plain(11.5));
        builder.put(texts.local_time, left + time + gap, builder.scaled(58), room - time - gap,
                    builder.quiet(11.5));
        return;
    }
    const double first = builder.scaled(20);
    const double second = builder.scaled(37);
    const double time =
        builder.put(texts.time, right, first, 0.6 * width, builder.plain(13.5), Align::right);
    builder.put(texts.title, left, first, right - time - gap - left, builder.strong(15));
    const double local =
        builder.put(texts.local_time, right, second, 0.4 * width, builder.quiet(11), Align::right);
    put_product(builder, texts, left, second, right - local - gap - left, 11);
}

FooterTexts footer_of(const Scene& scene, const FrameFacts& facts, const DrawnFacts& picture) {
    FooterTexts texts;
    texts.view = view_line(scene, facts, picture.ring_spacing_m);
    if (!picture.hail.empty()) texts.view += "  \u00B7  " + picture.hail;
    if (!facts.nowcast_score.empty()) texts.view += "  \u00B7  " + facts.nowcast_score;
    texts.seen = picture.sweep;
    const auto& coverage = picture.coverage;
    if (facts.antenna_to_picture) {
        texts.age = duration_text(*facts.antenna_to_picture) + " from antenna to picture";
    }
    if (coverage) {
        texts.seen =
            fmt::format("Seen: {} of the columns, {} below {}", percent_text(coverage->seen),
                        percent_text(coverage->seen_low), height_text(low_coverage_m, scene.units));
    }
    texts.credit = fmt::format("{}  \u00B7  stormcellar {}", map_credit, software_version);
    return texts;
}

void lay_out_footer(LabelBuilder& builder, double width, double height, const FooterTexts& texts) {
    const double left = builder.scaled(margin);
    const double right = width - left;
    const double gap = builder.scaled(14);
    const double first = height - builder.scaled(21);
    const double second = height - builder.scaled(7);
    const LabelStyle small = builder.quiet(8.5);
    double taken =
        builder.put(texts.age, right, first, 0.45 * width, builder.quiet(10), Align::right);
    builder.put(texts.view, left, first, right - taken - gap - left, builder.quiet(10));
    taken = builder.put(texts.credit, right, second, 0.55 * width, small, Align::right);
    builder.put(texts.seen, left, second, right - taken - gap - left, small);
}

Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene, const FrameFacts& facts,
                                   const DrawnFacts& picture) {
    if (auto room = check_room(scene); !room) return pass_on(room);
    const PictureSpace space = space_of(scene.width, scene.height);
    LabelLayout layout;
    layout.scale = space.scale;
    layout.shades = &shades_of(scene.theme);
    LabelBuilder builder(fonts, *layout.shades, layout.scale, layout);
    layout.top = space.header;
    layout.width = scene.width - space.panel;
    layout.height = scene.height - space.header - space.footer - space.band;
    Rect colors = {static_cast<double>(layout.width), static_cast<double>(layout.top),
                   static_cast<double>(space.panel), static_cast<double>(layout.height)};
    if (space.band > 0) {
        const double left = builder.scaled(margin);
        colors = {left, static_cast<double>(layout.top + layout.height), scene.width - 2 * left,
                  static_cast<double>(space.band)};
    }
    if (view_of(scene.product) == View::section)
        make_room_for_inset(space, builder, layout, colors);
    // Lines about storm cells and shapes are below the legend, or beside the product if the legend
    // is one line.
    Legend legend = picture.legend;
    std::string product = product_line(scene, facts);
    if (space.band > 0 && !picture.marks.empty())
        product += fmt::format("  \u00B7  {}", fmt::join(picture.marks, " "));
    if (space.band == 0) {
        if (!legend.notes.empty() && !picture.marks.empty()) legend.notes.back() += ";";
        legend.notes.insert(legend.notes.end(), picture.marks.begin(), picture.marks.end());
    }
    lay_out_header(builder, space.shape, scene.width, header_of(facts, product));
    lay_out_footer(builder, scene.width, scene.height, footer_of(scene, facts, picture));
    if (space.band > 0) {
        lay_out_band(builder, legend, colors);
    } else {
        lay_out_panel(builder, legend, colors);
    }
    return layout;
}

void draw_labels(Canvas& canvas, const Fonts& fonts, const LabelLayout& layout) {
    for (const LabelBlock& block : layout.blocks) {
        if (!block.lines) {
            canvas.fill(block.box, block.color);
            continue;
        }
        Image swatch(static_cast<int>(block.box.width), static_cast<int>(block.box.height),
                     block.color);
        for (int y = 0; y < swatch.height; ++y) {
            for (int x = 0; x < swatch.width; ++x) {
                swatch.set(x, y, hatched(block.color, *block.lines, x, y, layout.scale));
            }
        }
        canvas.place(swatch, static_cast<int>(block.box.x), static_cast<int>(block.box.y));
    }
    for (const Rect& box : layout.outlines) {
        Rgba8 color = layout.shades->border;
        color[3] = 110;
        const double half = 0.5;
        canvas.line({{box.x - half, box.y - half},
                     {box.right() + half, box.y - half},
                     {box.right() + half, box.bottom() + half},
                     {box.x - half, box.bottom() + half}},
                    1, color, true);
    }
    for (const LabelText& text : layout.texts) {
        canvas.text(fonts, text.text, {text.box.x, text.baseline}, text.size, text.bold,
                    text.color);
    }
}

}  // namespace stormcellar::render

#include "render/map/labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/ranges.h>

#include "render/image/shades.h"
#include "render/map/base_map.h"
#include "render/map/colour_bar.h"
#include "render/products/ground.h"
#include "render/products/smooth_field.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

constexpr double usual_width = 796;
constexpr double usual_height = 532;
constexpr double header_height = 46;
constexpr double footer_height = 36;
constexpr double panel_width = 124;
constexpr double margin = 10;

double scale_of(const Scene& scene) {
    return std::clamp(std::min(scene.width / usual_width, scene.height / usual_height), 0.85, 4.0);
}

std::string direction_name(double azimuth_deg) {
    static constexpr std::array<const char*, 16> names = {"N",  "NNE", "NE", "ENE", "E",  "ESE",
                                                          "SE", "SSE", "S",  "SSW", "SW", "WSW",
                                                          "W",  "WNW", "NW", "NNW"};
    const double turn = azimuth_deg - 360 * std::floor(azimuth_deg / 360);
    return names[static_cast<std::size_t>(std::lround(turn / 22.5)) % names.size()];
}

std::string title_of(const FrameFacts& facts) {
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
    // The domain with the data of one site is named NAME.ICAO.
    if (facts.domain.ends_with("." + icao)) {
        const std::string name = facts.domain.substr(0, facts.domain.size() - icao.size() - 1);
        return fmt::format("{}  ({})", title, name);
    }
    if (facts.domain != icao) title = fmt::format("{}  ({})", facts.domain, title);
    return title;
}

std::string view_text(const Scene& scene) {
    const double tilt = scene.camera.tilt_deg;
    std::string text = tilt == 0 ? "Seen from above"
                                 : fmt::format("Seen from {}, {:g}\u00B0 from the vertical",
                                               direction_name(scene.camera.azimuth_deg), tilt);
    text += fmt::format("  \u00B7  vertical \u00D7{:g}", scene.vertical_exaggeration);
    if (scene.light.any()) text += fmt::format("  \u00B7  lit ({})", light_names(scene.light));
    return text;
}

std::string footer_of(const Scene& scene, const FrameFacts& facts, double ring_spacing_m) {
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
        text += fmt::format("  \u00B7  range rings every {:g} km", ring_spacing_m / 1000);
    }
    return text;
}

class Builder {
  public:
    Builder(const Fonts& fonts, LabelLayout& layout) : fonts_(fonts), layout_(layout) {}

    [[nodiscard]] double scaled(double length) const { return length * layout_.scale; }

    struct Style {
        double size = 10;  // before scaling
        bool bold = false;
        Rgba8 colour = shades::text;
    };

    // Draws text that starts (or ends) at `left`, made smaller and then cut to fit. Returns its
    // width.
    double put(std::string text, double left, double baseline, double room, const Style& style,
               bool ends_here = false) {
        if (text.empty() || room <= 0) return 0;
        double size = scaled(style.size);
        const double smallest = 0.75 * size;
        while (fonts_.width(text, size, style.bold) > room && size > smallest)
            size -= 0.25;
        text = shortened(std::move(text), size, style.bold, room);
        if (text.empty()) return 0;
        const double width = fonts_.width(text, size, style.bold);
        const double x = ends_here ? left - width : left;
        layout_.texts.push_back({{x, baseline - 0.8 * size, width, 1.05 * size},
                                 baseline,
                                 size,
                                 style.bold,
                                 style.colour,
                                 std::move(text)});
        return width;
    }

    void block(Rect box, Rgba8 colour, bool hatched = false) {
        layout_.blocks.push_back({box, colour, hatched});
    }

  private:
    // Returns the text with an ellipsis for what has no room; empty if even the ellipsis has none.
    [[nodiscard]] std::string shortened(std::string text, double size, bool bold,
                                        double room) const {
        if (fonts_.width(text, size, bold) <= room) return text;
        // Removes whole characters of UTF-8, and spaces before the ellipsis.
        const auto cut = [&text](std::size_t bytes) {
            while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U)
                --bytes;
            while (bytes > 0 && text[bytes - 1] == ' ')
                --bytes;
            return text.substr(0, bytes) + "\u2026";
        };
        std::size_t fits = 0;
        std::size_t too_long = text.size();
        while (too_long - fits > 1) {
            const std::size_t middle = (fits + too_long) / 2;
            (fonts_.width(cut(middle), size, bold) <= room ? fits : too_long) = middle;
        }
        return fits == 0 ? std::string{} : cut(fits);
    }

    const Fonts& fonts_;
    LabelLayout& layout_;
};

std::vector<std::string> warnings_of(const FrameFacts& facts) {
    std::vector<std::string> warnings;
    if (facts.partial) warnings.emplace_back("partial volume");
    warnings.insert(warnings.end(), facts.radar_troubles.begin(), facts.radar_troubles.end());
    return warnings;
}

// Returns the text below the time.
std::string beside_time(const FrameFacts& facts) {
    if (!facts.interpolated) return facts.local_time;
    return (facts.local_time.empty() ? "" : facts.local_time + "  \u00B7  ") + "interpolated";
}

void lay_out_header(Builder& builder, const Scene& scene, const FrameFacts& facts,
                    const std::string& product) {
    const double left = builder.scaled(margin);
    const double right = scene.width - left;
    const double first = builder.scaled(20);
    const double second = builder.scaled(37);
    const double gap = builder.scaled(14);

    std::string time = format_utc(std::chrono::floor<std::chrono::seconds>(facts.time));
    time = time.substr(0, 10) + " " + time.substr(11, 8) + " UTC";
    const double time_width =
        builder.put(time, right, first, 0.6 * scene.width, {14, true, shades::text}, true);
    builder.put(title_of(facts), left, first, right - time_width - gap - left,
                {14, true, shades::text});
    const double local_width = builder.put(beside_time(facts), right, second, 0.4 * scene.width,
                                           {11, false, shades::quiet_text}, true);
    // The warnings share a line with the product, so that the frames of a loop keep their place.
    const auto warnings = warnings_of(facts);
    const double room = right - local_width - gap - left;
    const double product_width =
        builder.put(product, left, second, warnings.empty() ? room : 0.6 * room,
                    {11, false, shades::quiet_text});
    builder.put(fmt::format("{}", fmt::join(warnings, "  \u00B7  ")), left + product_width + gap,
                second, room - product_width - gap, {11, true, shades::warning_text});
}

void lay_out_footer(Builder& builder, const Scene& scene, const FrameFacts& facts,
                    const PictureFacts& picture) {
    const double left = builder.scaled(margin);
    const double right = scene.width - left;
    const double gap = builder.scaled(14);
    const double first = scene.height - builder.scaled(21);
    const double second = scene.height - builder.scaled(7);
    const Builder::Style style = {10, false, shades::quiet_text};
    const Builder::Style small = {8.5, false, shades::quiet_text};

    double width = 0;
    if (facts.antenna_to_picture) {
        width = builder.put(duration_text(*facts.antenna_to_picture) + " from antenna to picture",
                            right, first, 0.45 * scene.width, style, true);
    }
    builder.put(footer_of(scene, facts, picture.ring_spacing_m), left, first,
                right - width - gap - left, style);
    const std::string software = fmt::format("stormcellar {}", software_version);
    const bool has_map = view_of(scene.product) != View::section;
    width = builder.put(has_map ? fmt::format("{}  \u00B7  {}", map_credit, software) : software,
                        right, second, 0.55 * scene.width, small, true);
    if (!picture.coverage) return;
    builder.put(fmt::format("Seen: {} of the columns, {} below {:g} km",
                            percent_text(picture.coverage->seen),
                            percent_text(picture.coverage->seen_low), low_coverage_m / 1000),
                left, second, right - width - gap - left, small);
}

void lay_out_bar(Builder& builder, const ColourTable& table, Rect box) {
    constexpr double size = 10;
    const double text_height = builder.scaled(size);
    const ColourBar bar = colour_bar(table, box, 1.15 * text_height);
    for (const BarBlock& block : bar.blocks)
        builder.block(block.box, block.colour);
    for (const BarTick& tick : bar.ticks) {
        builder.put(tick.text, box.right() + builder.scaled(6), tick.y + 0.3 * text_height,
                    builder.scaled(76), {size, false, shades::text});
    }
}

void lay_out_panel(Builder& builder, const Legend& legend, Rect panel) {
    const double x = panel.x + builder.scaled(12);
    const double room = panel.right() - builder.scaled(4) - x;
    const double row = builder.scaled(17);

    // From the bottom up: notes, legend, its heading. The bar takes what is left.
    double y = panel.bottom() - builder.scaled(4);
    for (auto note = legend.notes.rbegin(); note != legend.notes.rend(); ++note) {
        builder.put(*note, x, y, room, {9.5, false, shades::quiet_text});
        y -= builder.scaled(12);
    }
    if (!legend.notes.empty()) y -= builder.scaled(6);
    for (auto line = legend.rows.rbegin(); line != legend.rows.rend(); ++line) {
        const double edge = builder.scaled(11);
        builder.block({std::round(x), std::round(y - edge + builder.scaled(2)), std::round(edge),
                       std::round(edge)},
                      line->colour, line->hatched);
        const double text_x = x + edge + builder.scaled(6);
        builder.put(line->text, text_x, y, panel.right() - builder.scaled(4) - text_x,
                    {9.5, false, shades::text});
        y -= row;
    }
    if (!legend.heading.empty()) {
        builder.put(legend.heading, x, y, room, {10, true, shades::quiet_text});
        y -= row;
    }
    if (legend.table == nullptr) return;
    builder.put(legend.bar_heading, x, panel.y + builder.scaled(14), room,
                {11, true, shades::text});
    const double bar_top = std::round(panel.y + builder.scaled(24));
    lay_out_bar(builder, *legend.table,
                {std::round(x), bar_top, std::round(builder.scaled(20)),
                 std::max(15.0, std::round(y + builder.scaled(2) - bar_top))});
}

}  // namespace

std::string duration_text(std::chrono::seconds duration) {
    const auto seconds = duration.count();
    if (seconds < 60) return fmt::format("{} s", seconds);
    return fmt::format("{} min {} s", seconds / 60, seconds % 60);
}

Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene, const FrameFacts& facts,
                                   const PictureFacts& picture) {
    if (scene.width < smallest_labelled_width || scene.height < smallest_labelled_height) {
        return fail(ErrorCode::bad_argument,
                    "labels need a picture of at least {} by {} pixels, not {} by {}; leave them "
                    "out or draw a larger picture",
                    smallest_labelled_width, smallest_labelled_height, scene.width, scene.height);
    }
    LabelLayout layout;
    layout.scale = scale_of(scene);
    Builder builder(fonts, layout);
    layout.top = static_cast<int>(std::lround(builder.scaled(header_height)));
    layout.width = scene.width - static_cast<int>(std::lround(builder.scaled(panel_width)));
    layout.height =
        scene.height - layout.top - static_cast<int>(std::lround(builder.scaled(footer_height)));
    lay_out_header(builder, scene, facts, picture.legend.product);
    lay_out_footer(builder, scene, facts, picture);
    lay_out_panel(
        builder, picture.legend,
        {static_cast<double>(layout.width), static_cast<double>(layout.top),
         static_cast<double>(scene.width - layout.width), static_cast<double>(layout.height)});
    return layout;
}

void draw_labels(Canvas& canvas, const Fonts& fonts, const LabelLayout& layout) {
    for (const LabelBlock& block : layout.blocks) {
        if (!block.hatched) {
            canvas.fill(block.box, block.colour);
            continue;
        }
        Image swatch(static_cast<int>(block.box.width), static_cast<int>(block.box.height),
                     block.colour);
        for (int y = 0; y < swatch.height; ++y) {
            for (int x = 0; x < swatch.width; ++x) {
                swatch.set(x, y, shades::hatched(x, y, layout.scale));
            }
        }
        canvas.place(swatch, static_cast<int>(block.box.x), static_cast<int>(block.box.y));
    }
    for (const LabelText& text : layout.texts) {
        canvas.text(fonts, text.text, {text.box.x, text.baseline}, text.size, text.bold,
                    text.colour);
    }
}

}  // namespace stormcellar::render

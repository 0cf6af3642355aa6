#include "render/map/labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/station_table.h"
#include "base/version.h"
#include "render/colour/colour_bar.h"
#include "render/products/ground.h"
#include "render/products/product.h"
#include "render/shades.h"

namespace stormcellar::render {
namespace {

constexpr double usual_width = 796;
constexpr double usual_height = 532;
constexpr double header_height = 46;
constexpr double footer_height = 24;
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
    if (facts.domain != icao) title = fmt::format("{}  ({})", facts.domain, title);
    return title;
}

std::string footer_of(const Scene& scene, const FrameFacts& facts, double ring_spacing_m) {
    std::string text;
    if (scene.product == Product::volume) {
        const double tilt = scene.camera.tilt_deg;
        text = tilt == 0 ? "Seen from above"
                         : fmt::format("Seen from {}, {:g}\u00B0 from the vertical",
                                       direction_name(scene.camera.azimuth_deg), tilt);
        text += fmt::format("  \u00B7  vertical \u00D7{:g}", scene.vertical_exaggeration);
    } else if (scene.product == Product::section) {
        return "Vertical section from A to B";
    } else {
        text = "Map, north up";
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

    // Text that starts at `left` (or ends there); made smaller, then cut, to fit. Gives its width.
    double put(std::string text, double left, double baseline, double room, const Style& style,
               bool ends_here = false) {
        if (text.empty() || room <= 0) return 0;
        double size = scaled(style.size);
        const double smallest = 0.75 * size;
        while (fonts_.width(text, size, style.bold) > room && size > smallest)
            size -= 0.25;
        while (fonts_.width(text, size, style.bold) > room && !text.empty()) {
            // Whole characters of UTF-8 go.
            while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) {
                text.pop_back();
            }
            if (!text.empty()) text.pop_back();
        }
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
    const Fonts& fonts_;
    LabelLayout& layout_;
};

void lay_out_header(Builder& builder, const Scene& scene, const FrameFacts& facts) {
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
    double partial_width = 0;
    if (facts.partial) {
        partial_width = builder.put("partial volume", right, second, 0.4 * scene.width,
                                    {11, true, shades::warning_text}, true);
    }
    builder.put(product_title(scene), left, second, right - partial_width - gap - left,
                {11, false, shades::quiet_text});
}

void lay_out_footer(Builder& builder, const Scene& scene, const std::string& text) {
    const double left = builder.scaled(margin);
    const double right = scene.width - left;
    const double baseline = scene.height - builder.scaled(8);
    const double width =
        builder.put(fmt::format("stormcellar {}", software_version), right, baseline,
                    0.3 * scene.width, {9, false, shades::quiet_text}, true);
    builder.put(text, left, baseline, right - width - builder.scaled(14) - left,
                {10, false, shades::quiet_text});
}

std::vector<LegendRow> legend_of(const Scene& scene) {
    if (scene.product != Product::volume) return product_legend(scene);
    const std::string height = fmt::format("{:g} km", low_coverage_m / 1000);
    return {{"seen below " + height, shades::seen, false},
            {"seen above " + height, shades::seen_aloft, false},
            {"not seen", shades::not_seen, true}};
}

void lay_out_bar(Builder& builder, const ColourTable& table, Rect bar) {
    const double size = 10;
    const int most_ticks =
        std::max(2, static_cast<int>(bar.height / (1.15 * builder.scaled(size))));
    const ColourBar colours = colour_bar(table, most_ticks);
    const auto at = [&](double share) { return std::round(bar.bottom() - share * bar.height); };
    for (const BarBlock& block : colours.blocks) {
        // Whole pixels, so that no seam shows between the blocks.
        const double high = at(block.high);
        builder.block({bar.x, high, bar.width, at(block.low) - high}, block.colour);
    }
    for (const BarTick& tick : colours.ticks) {
        builder.put(tick.text, bar.right() + builder.scaled(6),
                    at(tick.at) + 0.3 * builder.scaled(size), builder.scaled(34),
                    {size, false, shades::text});
    }
}

void lay_out_panel(Builder& builder, const Scene& scene, Rect panel) {
    const double x = panel.x + builder.scaled(12);
    const double room = panel.right() - builder.scaled(4) - x;
    const double row = builder.scaled(17);
    const auto rows = legend_of(scene);
    const bool volume = scene.product == Product::volume;

    // From the bottom up: notes, legend, its heading; the bar takes what is left.
    double y = panel.bottom() - builder.scaled(4);
    if (volume) {
        builder.put("are clear", x, y, room, {9.5, false, shades::quiet_text});
        builder.put(clear_text(scene, "and"), x, y - builder.scaled(12), room,
                    {9.5, false, shades::quiet_text});
        y -= builder.scaled(30);
    }
    for (auto line = rows.rbegin(); line != rows.rend(); ++line) {
        const double edge = builder.scaled(11);
        builder.block({std::round(x), std::round(y - edge + builder.scaled(2)), std::round(edge),
                       std::round(edge)},
                      line->colour, line->hatched);
        const double text_x = x + edge + builder.scaled(6);
        builder.put(line->text, text_x, y, panel.right() - builder.scaled(4) - text_x,
                    {9.5, false, shades::text});
        y -= row;
    }
    if (volume) {
        builder.put("Coverage (ground)", x, y, room, {10, true, shades::quiet_text});
        y -= row;
    }
    builder.put(bar_heading(scene), x, panel.y + builder.scaled(14), room,
                {11, true, shades::text});
    const double bar_top = panel.y + builder.scaled(24);
    lay_out_bar(builder, colours_of(scene),
                {std::round(x), bar_top, std::round(builder.scaled(20)),
                 std::max(15.0, y + builder.scaled(2) - bar_top)});
}

}  // namespace

Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene, const FrameFacts& facts,
                                   double drawn_ring_spacing_m) {
    if (scene.width < smallest_labelled_width || scene.height < smallest_labelled_height) {
        return fail(ErrorCode::bad_argument,
                    "labels need a picture of at least {} by {} pixels, not {} by {}: leave them "
                    "out",
                    smallest_labelled_width, smallest_labelled_height, scene.width, scene.height);
    }
    LabelLayout layout;
    layout.scale = scale_of(scene);
    Builder builder(fonts, layout);
    layout.top = static_cast<int>(std::lround(builder.scaled(header_height)));
    layout.width = scene.width - static_cast<int>(std::lround(builder.scaled(panel_width)));
    layout.height =
        scene.height - layout.top - static_cast<int>(std::lround(builder.scaled(footer_height)));
    lay_out_header(builder, scene, facts);
    lay_out_footer(builder, scene, footer_of(scene, facts, drawn_ring_spacing_m));
    lay_out_panel(
        builder, scene,
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

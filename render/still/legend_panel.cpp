#include "render/still/legend_panel.h"

#include <algorithm>
#include <cmath>

#include "render/image/canvas.h"
#include "render/image/shades.h"
#include "render/map/color_bar.h"
#include "render/still/map_raster.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

constexpr double margin_px = 12;
constexpr double bar_height_px = 240;
constexpr double bar_width_px = 18;
constexpr double line_px = 17;
constexpr double text_px = 12;
constexpr double title_px = 13;

struct PanelLine {
    std::string text;
    bool bold = false;
    Rgba8 color{};
};

std::vector<PanelLine> lines_of(const StillMap& map, const Shades& shades) {
    std::vector<PanelLine> lines = {{product_title(map.scene), true, shades.text},
                                    {map.facts.domain, false, shades.quiet_text}};
    const std::string time = format_utc(map.facts.time);  // 2022-03-17T00:08:42.596Z
    lines.push_back({time.substr(0, 10) + " " + time.substr(11, 8) + " UTC", false, shades.text});
    if (!map.facts.local_time.empty())
        lines.push_back({map.facts.local_time, false, shades.quiet_text});
    if (map.facts.interpolated) lines.push_back({"interpolated", false, shades.warning_text});
    if (map.facts.partial) lines.push_back({"partial volume", false, shades.warning_text});
    return lines;
}

struct PanelState {
    std::string text;
    Rgba8 color{};
};

}  // namespace

Result<Image> draw_legend_panel(const StillMap& map) {
    const auto fonts = Fonts::load();
    if (!fonts) return pass_on(fonts);
    const Shades& shades = shades_of(map.scene.theme);
    const ColorTable& table = colors_of(map.scene);
    const std::vector<PanelLine> lines = lines_of(map, shades);
    std::vector<PanelState> states;
    if (facts_of(map.scene.product).has_echo_states)
        states.push_back({"range folded", table.range_folded});
    if (facts_of(map.scene.product).has_echo_states &&
        level2::facts_of(map.scene.moment).is_derived) {
        const Rgba8 ambiguous = overlay_color(grid::CellStatus::ambiguous, 0, table);
        states.push_back({"ambiguous", over(ambiguous, shades.land.seen)});
    }
    states.push_back({"not seen", over(unseen_veil, shades.text)});

    double widest = 0;
    for (const PanelLine& line : lines)
        widest =
            std::max(widest, fonts->width(line.text, line.bold ? title_px : text_px, line.bold));
    const double bar_top =
        margin_px + line_px * (static_cast<double>(lines.size()) + 1) + margin_px;
    const double states_top = bar_top + bar_height_px + margin_px;
    const double height = states_top + line_px * static_cast<double>(states.size()) + margin_px / 2;
    Canvas canvas(static_cast<int>(std::ceil(widest + 2 * margin_px)),
                  static_cast<int>(std::ceil(height)), shades.page);

    double baseline = margin_px + title_px - 2;
    for (const PanelLine& line : lines) {
        canvas.text(*fonts, line.text, {margin_px, baseline}, line.bold ? title_px : text_px,
                    line.bold, line.color);
        baseline += line_px;
    }
    const ShownUnit unit = written_unit(map.scene);
    canvas.text(
        *fonts,
        unit.symbol.empty() ? std::string(level2::moment_name(map.scene.moment)) : unit.symbol,
        {margin_px, bar_top - 6}, text_px, false, shades.quiet_text);
    const Rect bar{margin_px, bar_top, bar_width_px, bar_height_px};
    const ColorBar shown = color_bar({table, unit.per_stored}, bar, line_px - 2, shades.land.seen);
    for (const BarBlock& block : shown.blocks)
        canvas.fill(block.box, block.color);
    for (const BarTick& tick : shown.ticks) {
        canvas.text(*fonts, tick.text, {bar.right() + 8, tick.at + text_px / 3}, text_px, false,
                    shades.text);
    }
    baseline = states_top + text_px - 1;
    for (const PanelState& state : states) {
        canvas.fill({margin_px, baseline - text_px + 1, bar_width_px, text_px}, state.color);
        canvas.text(*fonts, state.text, {bar.right() + 8, baseline}, text_px, false, shades.text);
        baseline += line_px;
    }
    return canvas.image();
}

}  // namespace stormcellar::render

#include "render/map/legend_layout.h"

#include <algorithm>
#include <cmath>

#include "render/map/color_bar.h"

namespace stormcellar::render {
namespace {

constexpr double bar_text = 10;
constexpr double row_text = 9.5;
constexpr double swatch_side = 11;
constexpr std::size_t most_rows_of_line = 8;

// Returns the size of the letters, which is the same for all rows. If one row has no room, all rows
// become smaller, down to three quarters.
double size_of_rows(const LabelBuilder& builder, const std::vector<LegendRow>& rows, double room) {
    double size = row_text;
    const auto too_wide = [&](const LegendRow& row) {
        return builder.width_of(row.text, builder.plain(size)) > room;
    };
    while (size > 0.75 * row_text && std::ranges::any_of(rows, too_wide))
        size -= 0.125;
    return size;
}

void put_swatch(LabelBuilder& builder, const LegendRow& row, double x, double baseline) {
    const double side = std::round(builder.scaled(swatch_side));
    builder.block({std::round(x), std::round(baseline - side + builder.scaled(2)), side, side},
                  row.color, row.lines);
}

void lay_out_upright_bar(LabelBuilder& builder, const Legend& legend, const Rect& box) {
    const double text_height = builder.scaled(bar_text);
    const ColorBar bar = color_bar({*legend.table, legend.shown_per_value}, box, 1.15 * text_height,
                                   builder.shades().land.seen);
    for (const BarBlock& block : bar.blocks)
        builder.block(block.box, block.color);
    builder.outline(box);
    for (const BarTick& tick : bar.ticks) {
        builder.put(tick.text, box.right() + builder.scaled(6), tick.at + 0.3 * text_height,
                    builder.scaled(72), builder.plain(bar_text));
    }
}

// Puts the heading of the bar at its left, and the numbers below it. Returns the baseline of the
// numbers.
double lay_out_lying_bar(LabelBuilder& builder, const Legend& legend, const Rect& band) {
    const double height = std::round(builder.scaled(11));
    const double top = std::round(band.y + builder.scaled(9));
    const LabelStyle numbers = builder.plain(bar_text);
    const auto width_of = [&](const std::string& text) { return builder.width_of(text, numbers); };
    const double heading = builder.put(legend.bar_heading, band.x, top + 0.86 * height,
                                       0.25 * band.width, builder.strong(10.5));
    // The first and the last number are centered on the ends.
    const double aside = builder.scaled(16);
    const double left = std::round(band.x + heading + aside);
    const Rect box = {left, top, std::max(1.0, std::floor(band.right() - aside - left)), height};
    const ColorBar bar = lying_bar({*legend.table, legend.shown_per_value}, box, width_of,
                                   builder.scaled(7), builder.shades().land.seen);
    for (const BarBlock& block : bar.blocks)
        builder.block(block.box, block.color);
    builder.outline(box);
    const double baseline = top + height + builder.scaled(11);
    for (const BarTick& tick : bar.ticks) {
        const double half = width_of(tick.text) / 2;
        const double x =
            std::clamp(tick.at, band.x + half, std::max(band.x + half, band.right() - half));
        builder.put(tick.text, x, baseline, band.width, numbers, Align::middle);
    }
    return baseline;
}

// An item in the line of the legend. It is a row, a heading or a note; headings and notes have no
// swatch.
struct LineItem {
    std::string text;
    LabelStyle style;
    const LegendRow* row = nullptr;
    double width = 0;
};

void lay_out_line(LabelBuilder& builder, const Legend& legend, const Rect& band, double baseline) {
    std::vector<LineItem> items;
    if (!legend.heading.empty()) {
        items.push_back(
            {legend.heading, {row_text, true, builder.shades().quiet_text}, nullptr, 0});
    }
    for (const LegendRow& row : legend.rows)
        items.push_back({row.text, builder.plain(row_text), &row, 0});
    std::string notes;
    for (const std::string& note : legend.notes)
        notes += (notes.empty() ? "" : " ") + note;
    if (!notes.empty()) items.push_back({notes, builder.quiet(row_text), nullptr, 0});
    if (items.empty()) return;
    const double swatch = builder.scaled(swatch_side + 6);
    const double gap = builder.scaled(14);
    double texts = 0;
    double rest = band.width - gap * static_cast<double>(items.size() - 1);
    for (LineItem& item : items) {
        item.width = builder.width_of(item.text, item.style);
        texts += item.width;
        if (item.row != nullptr) rest -= swatch;
    }
    const double share = std::min(1.0, rest / texts);
    double x = band.x;
    for (const LineItem& item : items) {
        if (item.row != nullptr) {
            put_swatch(builder, *item.row, x, baseline);
            x += swatch;
        }
        builder.put(item.text, x, baseline, share * item.width + 0.01, item.style);
        x += share * item.width + gap;
    }
}

}  // namespace

void lay_out_panel(LabelBuilder& builder, const Legend& legend, const Rect& panel) {
    const double x = panel.x + builder.scaled(12);
    const double room = panel.right() - builder.scaled(4) - x;
    const double row = builder.scaled(17);

    // Work from the bottom up: notes, legend, heading of the legend. The bar takes what is left.
    double y = panel.bottom() - builder.scaled(4);
    for (auto note = legend.notes.rbegin(); note != legend.notes.rend(); ++note) {
        builder.put(*note, x, y, room, builder.quiet(row_text));
        y -= builder.scaled(12);
    }
    if (!legend.notes.empty()) y -= builder.scaled(6);
    const double text_x = x + builder.scaled(swatch_side + 6);
    const double row_room = panel.right() - builder.scaled(4) - text_x;
    const double row_size = size_of_rows(builder, legend.rows, row_room);
    for (auto line = legend.rows.rbegin(); line != legend.rows.rend(); ++line) {
        put_swatch(builder, *line, x, y);
        builder.put(line->text, text_x, y, row_room, builder.plain(row_size));
        y -= row;
    }
    if (!legend.heading.empty()) {
        builder.put(legend.heading, x, y, room, {10, true, builder.shades().quiet_text});
        y -= row;
    }
    if (legend.table == nullptr) return;
    builder.put(legend.bar_heading, x, panel.y + builder.scaled(13), room, builder.strong(11));
    const double top = std::round(panel.y + builder.scaled(24));
    lay_out_upright_bar(builder, legend,
                        {std::round(x), top, std::round(builder.scaled(18)),
                         std::max(15.0, std::round(y - builder.scaled(2) - top))});
}

void lay_out_band(LabelBuilder& builder, const Legend& legend, const Rect& band, bool rows) {
    double baseline = band.y + builder.scaled(9);
    if (legend.table != nullptr) baseline = lay_out_lying_bar(builder, legend, band);
    if (!rows) return;
    if (legend.table == nullptr && legend.rows.size() > most_rows_of_line) {
        // The rows take the place of the bar, too.
        const auto middle =
            legend.rows.begin() + static_cast<std::ptrdiff_t>((legend.rows.size() + 1) / 2);
        Legend upper, lower;
        upper.heading = legend.heading;
        lower.notes = legend.notes;
        upper.rows.assign(legend.rows.begin(), middle);
        lower.rows.assign(middle, legend.rows.end());
        lay_out_line(builder, upper, band, baseline + builder.scaled(10));
        lay_out_line(builder, lower, band, baseline + builder.scaled(28));
        return;
    }
    lay_out_line(builder, legend, band, baseline + builder.scaled(18));
}

}  // namespace stormcellar::render

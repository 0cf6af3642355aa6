#include "accuracy/plot.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "accuracy/plot_layout.h"
#include "base/printable.h"
#include "stormcellar/accuracy/quantity.h"

namespace stormcellar::accuracy {
namespace {

// The colors of Okabe and Ito (2008), without yellow, which is too pale on white.
constexpr std::array<std::string_view, 7> colors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                    "#E69F00", "#56B4E9", "#000000"};
constexpr int shape_count = 5;
constexpr double front_width = 1.5;
constexpr double main_front_width = 3;
constexpr double title_size = 17;
constexpr double bold_width = 0.62;  // width of a letter, as a share of its size

// Escapes the special characters of XML, and replaces characters that XML does not allow.
std::string escaped(std::string_view text) {
    std::string safe;
    const std::string clean = printable(text);
    for (std::size_t i = 0; i < clean.size(); ++i) {
        const std::string_view rest = std::string_view(clean).substr(i);
        if (rest.starts_with("\xEF\xBF\xBE") || rest.starts_with("\xEF\xBF\xBF")) {
            safe += "\xEF\xBF\xBD";  // U+FFFE and U+FFFF are not XML characters
            i += 2;
        } else if (rest.front() == '&') {
            safe += "&amp;";
        } else if (rest.front() == '<') {
            safe += "&lt;";
        } else if (rest.front() == '>') {
            safe += "&gt;";
        } else if (rest.front() == '"') {
            safe += "&quot;";
        } else {
            safe += rest.front();
        }
    }
    return safe;
}

std::string line(double x1, double y1, double x2, double y2, std::string_view style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1,
                       y1, x2, y2, style);
}

std::string text_at(double x, double y, std::string_view style, std::string_view text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, style,
                       escaped(text));
}

std::string_view color_of(std::size_t series) {
    return colors[series % colors.size()];
}

// Draws a circle, square, diamond, or triangle up or down. The 35 combinations of 7 colors and 5
// shapes repeat after 35 series.
std::string marker_shape(double x, double y, std::size_t series, bool filled) {
    const std::string style =
        fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.8\"",
                    filled ? color_of(series) : std::string_view("#ffffff"), color_of(series));
    constexpr double r = marker_radius;
    switch (series % shape_count) {
        case 0:
            return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", x, y, r,
                               style);
        case 1:
            return fmt::format("<path d=\"M{:.1f} {:.1f}h{}v{}h{}z\" {}/>\n", x - r, y - r, 2 * r,
                               2 * r, -2 * r, style);
        case 2:
            return fmt::format("<path d=\"M{:.1f} {:.1f}l{} {}h{}z\" {}/>\n", x, y - r, r, 2 * r,
                               -2 * r, style);
        case 3:
            return fmt::format("<path d=\"M{:.1f} {:.1f}l{} {}l{} {}l{} {}z\" {}/>\n", x, y - r, r,
                               r, -r, r, -r, -r, style);
        default:
            return fmt::format("<path d=\"M{:.1f} {:.1f}h{}l{} {}z\" {}/>\n", x - r, y - r, 2 * r,
                               -r, 2 * r, style);
    }
}

std::string draw_axes(const Plot& plot, const PlotLayout& layout) {
    const PlotBox& frame = layout.frame;
    std::string svg = fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#444444\"/>\n",
        frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
    constexpr std::string_view grid = "stroke=\"#dddddd\"";
    for (const PlotTick& tick : layout.time_ticks) {
        svg += line(tick.position, frame.top, tick.position, frame.bottom, grid);
        svg += text_at(tick.position, frame.bottom + 18, "text-anchor=\"middle\" font-size=\"12\"",
                       tick.text);
    }
    constexpr std::string_view to_the_left = "text-anchor=\"end\" font-size=\"12\"";
    for (const PlotTick& tick : layout.error_ticks) {
        svg += line(frame.left, tick.position, frame.right, tick.position, grid);
        svg += text_at(frame.left - 8, tick.position + 4, to_the_left, tick.text);
    }
    if (layout.zero_y) {
        const double border = 2 * *layout.zero_y - frame.bottom;
        svg += line(frame.left, border, frame.right, border,
                    "stroke=\"#444444\" stroke-dasharray=\"4 3\"");
        const std::string text =
            layout.zero_below > 0 ? "< " + format_number(layout.zero_below) : "0";
        svg += text_at(frame.left - 8, *layout.zero_y + 4, to_the_left, text);
    }
    const double middle_x = (frame.left + frame.right) / 2;
    const double middle_y = (frame.top + frame.bottom) / 2;
    svg += text_at(middle_x, frame.bottom + 44, "text-anchor=\"middle\" font-size=\"14\"",
                   plot.time_label);
    svg += text_at(20, middle_y,
                   fmt::format("text-anchor=\"middle\" font-size=\"14\" "
                               "transform=\"rotate(-90 20 {:.1f})\"",
                               middle_y),
                   plot.error_label);
    return svg;
}

// Returns the size of the title's letters: the largest, up to title_size, at which the title fits,
// but at least 9.
double size_of_title(const Plot& plot) {
    const auto letters = static_cast<double>(std::max<std::size_t>(1, plot.title.size()));
    return std::clamp((plot.width - 24) / (letters * bold_width), 9.0, title_size);
}

std::string draw_heading(const Plot& plot, const PlotLayout& layout) {
    const double middle = plot.width / 2.0;
    std::string svg =
        text_at(middle, title_y,
                fmt::format("text-anchor=\"middle\" font-size=\"{:.1f}\" font-weight=\"bold\"",
                            size_of_title(plot)),
                plot.title);
    for (std::size_t i = 0; i < plot.below.size(); ++i) {
        svg += text_at(middle, layout.lines_below[i],
                       "text-anchor=\"middle\" font-size=\"13\" fill=\"#555555\"", plot.below[i]);
    }
    return svg;
}

std::string draw_fronts(const Plot& plot, const PlotLayout& layout) {
    std::string svg;
    for (std::size_t series = 0; series < layout.series.size(); ++series) {
        const std::vector<PlotMarker>& front = layout.fronts[series];
        if (front.size() < 2) continue;
        svg += "<polyline points=\"";
        for (const PlotMarker& marker : front)
            svg += fmt::format("{:.1f},{:.1f} ", marker.x, marker.y);
        svg.pop_back();
        const bool is_main = layout.series[series] == plot.main_series;
        svg += fmt::format("\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" opacity=\"0.6\"/>\n",
                           color_of(series), is_main ? main_front_width : front_width);
    }
    return svg;
}

std::string draw_points(const Plot& plot, const PlotLayout& layout) {
    std::string svg;
    for (const PlotLabel& label : layout.labels) {
        if (!label.leader) continue;
        const PlotMarker& marker = layout.markers[label.marker];
        const double x = std::clamp(marker.x, label.box.left, label.box.right);
        const double y = std::clamp(marker.y, label.box.top, label.box.bottom);
        svg += line(marker.x, marker.y, x, y, "stroke=\"#888888\" stroke-width=\"0.8\"");
    }
    for (const PlotMarker& marker : layout.markers) {
        svg += marker_shape(marker.x, marker.y, marker.series, marker.pareto);
    }
    // A white edge keeps letters readable over lines.
    const std::string style = fmt::format(
        "font-size=\"{}\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" "
        "paint-order=\"stroke\"",
        label_size);
    for (const PlotLabel& label : layout.labels) {
        double x = (label.box.left + label.box.right) / 2;
        std::string_view anchor = "text-anchor=\"middle\" ";
        if (label.side == PlotLabel::Side::left) {
            x = label.box.left;
            anchor = "text-anchor=\"start\" ";
        } else if (label.side == PlotLabel::Side::right) {
            x = label.box.right;
            anchor = "text-anchor=\"end\" ";
        }
        const std::size_t series = layout.markers[label.marker].series;
        const bool is_main = layout.series[series] == plot.main_series;
        svg += text_at(x, label.box.bottom - 0.3 * label_size,
                       std::string(anchor) + style + (is_main ? " font-weight=\"bold\"" : ""),
                       label.text);
    }
    return svg;
}

std::string draw_legend(const PlotLayout& layout) {
    std::string svg;
    const double x = layout.frame.right + 34;
    double y = layout.frame.top + 10;
    for (std::size_t series = 0; series < layout.series.size(); ++series) {
        svg += marker_shape(x, y, series, true);
        svg += text_at(x + 12, y + 4, "font-size=\"12\"", layout.series[series]);
        y += 20;
    }
    svg += text_at(x - 6, y + 12, "font-size=\"11\"", "filled: no rung of");
    svg += text_at(x - 6, y + 26, "font-size=\"11\"", "its step is faster");
    svg += text_at(x - 6, y + 40, "font-size=\"11\"", "and more accurate");
    return svg;
}

}  // namespace

Result<std::string> draw_plot(const Plot& plot) {
    const auto layout = lay_out_plot(plot);
    if (!layout) return pass_on(layout);
    std::string svg = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
        "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" fill=\"#222222\">\n"
        "<title>{2}</title>\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        plot.width, plot.height, escaped(plot.title));
    svg += draw_heading(plot, *layout);
    svg += draw_axes(plot, *layout);
    svg += draw_fronts(plot, *layout);
    svg += draw_points(plot, *layout);
    svg += draw_legend(*layout);
    return svg + "</svg>\n";
}

}  // namespace stormcellar::accuracy

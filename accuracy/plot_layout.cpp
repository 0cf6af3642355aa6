#include "accuracy/plot_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stormcellar/accuracy/quantity.h"

namespace stormcellar::accuracy {
namespace {

constexpr double margin_left = 84;
constexpr double margin_right = 150;  // holds the legend
constexpr double margin_top = 26;     // below the title and its lines
constexpr double margin_bottom = 64;
constexpr double zero_row_height = 36;
constexpr double character_width =
    0.62;  // as a share of the letter size; bold letters are a little wider than the average
constexpr std::size_t most_points = 400;
constexpr double most_decades = 4;

Status validate(const Plot& plot) {
    if (plot.width < 400 || plot.width > 4000 || plot.height < 400 || plot.height > 4000) {
        return fail(ErrorCode::bad_argument, "a plot has 400 to 4000 pixels each way, not {} x {}",
                    plot.width, plot.height);
    }
    if (plot.points.empty() || plot.points.size() > most_points) {
        return fail(ErrorCode::bad_argument, "a plot has 1 to {} points, not {}", most_points,
                    plot.points.size());
    }
    for (const PlotPoint& point : plot.points) {
        const bool finite = std::isfinite(point.time_s) && std::isfinite(point.error);
        if (!finite || point.time_s <= 0 || point.error < 0) {
            return fail(ErrorCode::bad_argument, "point \"{}\" does not fit on the plot",
                        point.label);
        }
    }
    return {};
}

// Returns the value four decades below the greatest error if there are errors below that value,
// else 0.
double least_on_the_axis(const Plot& plot) {
    double greatest = 0;
    for (const PlotPoint& point : plot.points)
        greatest = std::max(greatest, point.error);
    const double least = greatest * std::pow(10, -most_decades);
    const bool needed =
        std::any_of(plot.points.begin(), plot.points.end(),
                    [&](const PlotPoint& point) { return point.error > 0 && point.error < least; });
    return needed ? least : 0;
}

// A logarithmic axis between two pixel positions.
struct Axis {
    double low = 0, high = 1;  // log10
    double from = 0, to = 1;   // pixels

    [[nodiscard]] double position(double number) const {
        return from + (std::log10(number) - low) / (high - low) * (to - from);
    }
};

Axis make_axis(const std::vector<double>& numbers, double from, double to) {
    Axis axis{0, 0, from, to};
    bool first = true;
    for (const double number : numbers) {
        const double log = std::log10(number);
        axis.low = first ? log : std::min(axis.low, log);
        axis.high = first ? log : std::max(axis.high, log);
        first = false;
    }
    // Leave room at both ends, and make the axis at least one decade long.
    const double room = std::max(0.08 * (axis.high - axis.low), 0.12);
    axis.low -= room;
    axis.high += room;
    if (axis.high - axis.low < 1) {
        const double more = (1 - (axis.high - axis.low)) / 2;
        axis.low -= more;
        axis.high += more;
    }
    return axis;
}

template <class Text>
std::vector<PlotTick> make_ticks(const Axis& axis, const Text& text) {
    const double span = axis.high - axis.low;
    const std::vector<int> leads = span < 3.5 ? std::vector<int>{1, 2, 5} : std::vector<int>{1};
    const int step = std::max(1, static_cast<int>(std::ceil(span / 9)));
    std::vector<PlotTick> ticks;
    for (int decade = static_cast<int>(std::floor(axis.low));
         decade <= static_cast<int>(std::ceil(axis.high)); ++decade) {
        if (decade % step != 0) continue;
        for (const int lead : leads) {
            const double number = lead * std::pow(10, decade);
            const double log = decade + std::log10(lead);
            if (log < axis.low || log > axis.high || number <= 0) continue;
            ticks.push_back({axis.position(number), text(number)});
        }
    }
    return ticks;
}

std::size_t characters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

PlotBox marker_box(const PlotMarker& marker) {
    constexpr double reach = marker_radius + 1;
    return {marker.x - reach, marker.y - reach, marker.x + reach, marker.y + reach};
}

// Returns a box of the label's size beside the marker, in direction (dx, dy). Each of dx and dy is
// -1, 0 or 1.
PlotBox label_box(const PlotMarker& marker, const std::string& text, double dx, double dy,
                  double distance) {
    const double width = static_cast<double>(characters(text)) * label_size * character_width;
    const double height = label_size * 1.2;
    const double x = marker.x + dx * (distance + width / 2);
    const double y = marker.y + dy * (distance + height / 2);
    return {x - width / 2, y - height / 2, x + width / 2, y + height / 2};
}

// Returns the length of a line inside a box, in pixels. The length is counted in steps of 2 pixels,
// which is exact enough to compare places.
double length_within(const PlotBox& box, const PlotMarker& from, const PlotMarker& to) {
    constexpr double step = 2;
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const int steps = static_cast<int>(length / step);
    double within = 0;
    for (int i = 0; i <= steps; ++i) {
        const double part = steps == 0 ? 0 : static_cast<double>(i) / steps;
        const double x = from.x + part * (to.x - from.x);
        const double y = from.y + part * (to.y - from.y);
        if (x > box.left && x < box.right && y > box.top && y < box.bottom) within += step;
    }
    return within;
}

// Returns the cost of a place for a label: how much it hides, and how far it is beyond the frame.
double cost_of(const PlotBox& box, const PlotLayout& layout, const PlotBox& room) {
    double cost = 0;
    for (const PlotLabel& label : layout.labels)
        cost += 2 * box.overlap(label.box);
    for (const PlotMarker& marker : layout.markers)
        cost += 3 * box.overlap(marker_box(marker));
    // An overlap with a line counts less, because the label's white edge keeps it readable.
    for (const auto& front : layout.fronts) {
        for (std::size_t i = 1; i < front.size(); ++i)
            cost += 0.5 * length_within(box, front[i - 1], front[i]);
    }
    const double area = (box.right - box.left) * (box.bottom - box.top);
    return cost + 4 * (area - box.overlap(room));
}

// Places a label beside its marker if there is room, else farther away. Takes the first of equally
// good places.
PlotLabel place_label(const PlotLayout& layout, std::size_t marker, const std::string& text) {
    struct Direction {
        double dx, dy;
    };
    constexpr std::array<Direction, 8> directions = {
        {{1, 0}, {0, -1}, {0, 1}, {-1, 0}, {1, -1}, {1, 1}, {-1, -1}, {-1, 1}}};
    constexpr double touching = marker_radius + 3;
    constexpr double least_cost = 1e-6;
    const PlotBox& room = layout.frame;
    PlotLabel best;
    double best_cost = -1;
    constexpr int distances = 16;
    for (int farther = 0; farther < distances; ++farther) {
        const double distance = (1 + 1.2 * farther) * touching;
        for (const Direction& direction : directions) {
            const PlotBox box =
                label_box(layout.markers[marker], text, direction.dx, direction.dy, distance);
            const double cost = cost_of(box, layout, room);
            if (best_cost >= 0 && cost >= best_cost - least_cost) continue;
            const auto side = direction.dx > 0   ? PlotLabel::Side::left
                              : direction.dx < 0 ? PlotLabel::Side::right
                                                 : PlotLabel::Side::middle;
            best = {box, side, text, marker, farther > 0};
            best_cost = cost;
        }
        if (best_cost < least_cost) break;
    }
    return best;
}

std::size_t series_index(std::vector<std::string>& series, const std::string& name) {
    const auto found = std::find(series.begin(), series.end(), name);
    if (found != series.end()) return static_cast<std::size_t>(found - series.begin());
    series.push_back(name);
    return series.size() - 1;
}

// Returns the points on each series' front, from left to right.
std::vector<std::vector<PlotMarker>> fronts_of(const PlotLayout& layout) {
    std::vector<std::vector<PlotMarker>> fronts(layout.series.size());
    for (const PlotMarker& marker : layout.markers)
        if (marker.pareto) fronts[marker.series].push_back(marker);
    for (std::vector<PlotMarker>& front : fronts) {
        std::stable_sort(front.begin(), front.end(), [](const PlotMarker& a, const PlotMarker& b) {
            return a.x != b.x ? a.x < b.x : a.y < b.y;
        });
    }
    return fronts;
}

}  // namespace

double PlotBox::overlap(const PlotBox& other) const {
    const double width = std::min(right, other.right) - std::max(left, other.left);
    const double height = std::min(bottom, other.bottom) - std::max(top, other.top);
    return width > 0 && height > 0 ? width * height : 0;
}

Result<PlotLayout> lay_out_plot(const Plot& plot) {
    if (auto valid = validate(plot); !valid) return pass_on(valid);
    PlotLayout layout;
    for (std::size_t i = 0; i < plot.below.size(); ++i)
        layout.lines_below.push_back(title_y + line_height * static_cast<double>(i + 1));
    const double heading = layout.lines_below.empty() ? title_y : layout.lines_below.back();
    layout.frame = {margin_left, heading + margin_top, plot.width - margin_right,
                    plot.height - margin_bottom};
    std::vector<double> times;
    std::vector<double> errors;
    bool exact = false;
    layout.zero_below = least_on_the_axis(plot);
    const auto in_zero_row = [&](const PlotPoint& point) {
        return point.error <= 0 || point.error < layout.zero_below;
    };
    for (const PlotPoint& point : plot.points) {
        times.push_back(point.time_s);
        if (!in_zero_row(point)) {
            errors.push_back(point.error);
        } else {
            exact = true;
        }
    }
    const Axis time_axis = make_axis(times, layout.frame.left, layout.frame.right);
    const double bottom = layout.frame.bottom - (exact ? zero_row_height : 0);
    const Axis error_axis = make_axis(errors, bottom, layout.frame.top);
    if (exact) layout.zero_y = layout.frame.bottom - zero_row_height / 2;
    layout.time_ticks = make_ticks(time_axis, format_seconds);
    if (!errors.empty()) layout.error_ticks = make_ticks(error_axis, format_number);
    for (const PlotPoint& point : plot.points) {
        const double y = in_zero_row(point) ? layout.frame.bottom - zero_row_height / 2
                                            : error_axis.position(point.error);
        layout.markers.push_back({time_axis.position(point.time_s), y,
                                  series_index(layout.series, point.series), point.pareto});
    }
    layout.fronts = fronts_of(layout);
    for (std::size_t i = 0; i < plot.points.size(); ++i) {
        layout.labels.push_back(place_label(layout, i, plot.points[i].label));
    }
    return layout;
}

}  // namespace stormcellar::accuracy

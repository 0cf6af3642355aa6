#include "render/wind/time_height.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/image/round_step.h"
#include "render/view/length_text.h"
#include "render/wind/wind_barb.h"

namespace stormcellar::render {
namespace {

using retrieve::WindLayer;

constexpr double top_edge_px = 66, bottom_edge_px = 86, left_edge_px = 46, right_edge_px = 18;
constexpr double least_shown_m = 3'000;  // above the antenna
constexpr double column_px = 26, row_px = 15;
constexpr double least_barb_px = 24, most_barb_px = 36;

constexpr std::size_t class_count = 5;
// Returns the speed at which a class of colors ends, in m/s.
double class_end_mps(std::size_t number, const Units& units) {
    const double step = units.speed == Unit::mps ? 10 : 20 * facts_of(Unit::knots).si;
    return static_cast<double>(number + 1) * step;
}

Rgba8 class_color(std::size_t number, Theme theme) {
    constexpr std::array<Rgba8, class_count> on_dark = {{{150, 178, 210, 255},
                                                         {92, 208, 150, 255},
                                                         {250, 214, 84, 255},
                                                         {255, 138, 60, 255},
                                                         {255, 90, 140, 255}}};
    constexpr std::array<Rgba8, class_count> on_light = {{{84, 112, 150, 255},
                                                          {12, 124, 70, 255},
                                                          {164, 116, 0, 255},
                                                          {196, 72, 0, 255},
                                                          {186, 10, 80, 255}}};
    return (theme == Theme::dark ? on_dark : on_light)[number];
}

double highest_wind_m(std::span<const WindColumn> columns) {
    double top = least_shown_m;
    for (const WindColumn& column : columns)
        for (const WindLayer& layer : column.layers)
            if (layer.wind) top = std::max(top, layer.top_m);
    return top;
}

// Chooses columns from left to right that are at least this far apart.
std::vector<std::size_t> columns_apart(const TimeHeightPlan& plan,
                                       std::span<const WindColumn> columns, double apart_px) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const bool has_room =
            chosen.empty() ||
            plan.x_of(columns[i].time) - plan.x_of(columns[chosen.back()].time) >= apart_px;
        if (has_room) chosen.push_back(i);
    }
    return chosen;
}

class TimeHeight {
  public:
    TimeHeight(const WindPage& page, std::span<const WindColumn> columns, const Fonts& fonts)
        : page_(page),
          columns_(columns),
          plan_(plan_time_height(page, columns)),
          height_(facts_of(page.units.height)),
          on_(page, fonts),
          scale_(on_.scale()) {}

    Image draw() {
        const std::string first = minute_text(columns_.front().time);
        const std::string last = minute_text(columns_.back().time);
        on_.write_title(
            page_.station + " wind by time and height",
            (first == last ? first : first + " to " + last) + "  \u00B7  " + page_.method);
        draw_heights();
        draw_times();
        for (const std::size_t column : plan_.columns)
            draw_column(columns_[column]);
        write_colors();
        write_barbs();
        return on_.canvas().image();
    }

  private:
    void draw_heights() {
        const Rect& plot = plan_.plot;
        on_.write(fmt::format("Height above sea level, {}", height_.symbol),
                  {14 * scale_, plot.y - 8 * scale_},
                  {.size = 10, .is_quiet = true, .room = plot.width});
        const double step = round_step((plan_.top_m - plan_.bottom_m) / height_.si,
                                       std::max(2, static_cast<int>(plot.height / (48 * scale_))));
        const auto begin = static_cast<int>(std::ceil(plan_.bottom_m / height_.si / step - 1e-9));
        for (int i = begin; i * step * height_.si <= plan_.top_m; ++i) {
            const double y = plan_.y_of(i * step * height_.si);
            on_.canvas().line({{plot.x, y}, {plot.right(), y}}, scale_, on_.shades().ring, false);
            on_.write(number_text(i * step), {plot.x - 6 * scale_, y + 3.5 * scale_},
                      {.size = 10, .is_quiet = true, .share = 1});
        }
        on_.canvas().line({{plot.x, plot.y},
                           {plot.right(), plot.y},
                           {plot.right(), plot.bottom()},
                           {plot.x, plot.bottom()}},
                          scale_, on_.shades().border, true);
    }

    void draw_times() {
        const Rect& plot = plan_.plot;
        for (const std::size_t column : columns_apart(plan_, columns_, 40 * scale_)) {
            const double x = plan_.x_of(columns_[column].time);
            on_.canvas().line({{x, plot.bottom()}, {x, plot.bottom() + 4 * scale_}}, scale_,
                              on_.shades().border, false);
            on_.write(minute_text(columns_[column].time).substr(11, 5),
                      {x, plot.bottom() + 16 * scale_},
                      {.size = 10, .is_quiet = true, .share = 0.5});
        }
    }

    void draw_column(const WindColumn& column) {
        const double x = plan_.x_of(column.time);
        for (std::size_t i = 0; i < column.layers.size(); i += plan_.layer_step) {
            const WindLayer& layer = column.layers[i];
            if (!layer.wind) continue;
            const bool is_of_birds = layer.wind->birds == retrieve::Birds::likely;
            const Rgba8 color = is_of_birds ? on_.shades().border
                                            : wind_speed_color(layer.wind->motion.speed_mps(),
                                                               page_.units, page_.theme);
            draw_wind_barb(on_.canvas(),
                           {x, plan_.y_of(page_.antenna_altitude_m + layer.middle_m())},
                           layer.wind->motion, plan_.barb_px, 1.4 * scale_, color);
        }
    }

    void write_colors() {
        const double row = plan_.plot.bottom() + 38 * scale_;
        const UnitFacts& speed = facts_of(page_.units.speed);
        double x = 14 * scale_;
        const double room = (page_.width - 28 * scale_) / 7;
        const auto swatch = [&](Rgba8 color, const std::string& text) {
            on_.canvas().fill(Rect{x, row - 8 * scale_, 12 * scale_, 8 * scale_}, color);
            x = on_.write(text, {x + 16 * scale_, row}, {.size = 10, .room = room}) + 12 * scale_;
        };
        for (std::size_t i = 0; i < class_count; ++i) {
            const auto edge = [&](std::size_t number) {
                return number_text(class_end_mps(number, page_.units) / speed.si, 2);
            };
            swatch(class_color(i, page_.theme), i == 0 ? "below " + edge(0)
                                                : i + 1 == class_count
                                                    ? edge(i - 1) + " and more"
                                                    : edge(i - 1) + " to " + edge(i));
        }
        on_.write(std::string(speed.symbol), {x - 6 * scale_, row}, {.size = 10});
        x += 24 * scale_;
        swatch(on_.shades().border, "likely birds");
    }

    // Draws barbs of 5, 10 and 50 knots with their speeds.
    void write_barbs() {
        const double row = plan_.plot.bottom() + 64 * scale_;
        double x = 14 * scale_;
        for (const int knots : {5, 10, 50}) {
            draw_wind_barb(on_.canvas(), {x + plan_.barb_px, row - 3 * scale_},
                           {knots * facts_of(Unit::knots).si, 0}, plan_.barb_px, 1.4 * scale_,
                           on_.shades().text);
            x = on_.write(fmt::format("{} kt", knots), {x + plan_.barb_px + 6 * scale_, row},
                          {.size = 10}) +
                16 * scale_;
        }
        on_.write("the staff points to where the wind comes from", {x, row},
                  {.size = 10, .is_quiet = true, .room = page_.width - x - 14 * scale_});
    }

    const WindPage& page_;
    std::span<const WindColumn> columns_;
    TimeHeightPlan plan_;
    const UnitFacts& height_;
    WindCanvas on_;
    double scale_;
};

}  // namespace

double TimeHeightPlan::x_of(UtcTime time) const {
    const double span = seconds_between(first, last);
    const double margin = std::min(barb_px, plot.width / 2);
    if (span <= 0) return plot.x + plot.width / 2;
    return plot.x + margin + seconds_between(first, time) / span * (plot.width - 2 * margin);
}

double TimeHeightPlan::y_of(double height_m) const {
    return plot.bottom() - (height_m - bottom_m) / (top_m - bottom_m) * plot.height;
}

TimeHeightPlan plan_time_height(const WindPage& page, std::span<const WindColumn> columns) {
    const double scale = WindCanvas::scale_of(page);
    TimeHeightPlan plan;
    plan.plot = {left_edge_px * scale, top_edge_px * scale,
                 std::max(page.width - (left_edge_px + right_edge_px) * scale, 1.0),
                 std::max(page.height - (top_edge_px + bottom_edge_px) * scale, 1.0)};
    plan.first = columns.front().time;
    plan.last = columns.back().time;
    plan.bottom_m = page.antenna_altitude_m;
    plan.top_m = page.antenna_altitude_m + highest_wind_m(columns) * 1.03;
    plan.barb_px = least_barb_px * scale;
    plan.columns = columns_apart(plan, columns, column_px * scale);
    const auto& layers = columns.front().layers;
    if (!layers.empty()) {
        const double layer_px =
            plan.y_of(layers.front().bottom_m) - plan.y_of(layers.front().top_m);
        plan.layer_step = static_cast<std::size_t>(
            std::max(1.0, std::ceil(row_px * scale / std::max(layer_px, 0.01))));
        const double room = std::min(static_cast<double>(plan.layer_step) * layer_px,
                                     plan.plot.width / static_cast<double>(plan.columns.size()));
        plan.barb_px = std::clamp(0.9 * room, least_barb_px * scale, most_barb_px * scale);
    }
    return plan;
}

Rgba8 wind_speed_color(double speed_mps, const Units& units, Theme theme) {
    std::size_t number = 0;
    while (number + 1 < class_count && speed_mps >= class_end_mps(number, units))
        ++number;
    return class_color(number, theme);
}

Image draw_time_height(const WindPage& page, std::span<const WindColumn> columns,
                       const Fonts& fonts) {
    return TimeHeight(page, columns, fonts).draw();
}

}  // namespace stormcellar::render

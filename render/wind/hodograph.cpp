#include "render/wind/hodograph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/degree.h"
#include "render/image/round_step.h"
#include "render/view/length_text.h"

namespace stormcellar::render {
namespace {

using retrieve::Motion;
using retrieve::StormMotions;
using retrieve::WindLayer;

constexpr double title_height_px = 50, key_height_px = 108, side_margin_px = 14;
constexpr int most_rings_shown = 6;
constexpr double least_span_mps = 12;
// Winds farther apart than the first length are joined by a thin line. Winds farther apart than the
// second length are not joined.
constexpr double most_gap_m = 650, widest_gap_m = 1'500;

constexpr std::size_t band_count = 5;
using Edges = std::array<double, band_count - 1>;
// The heights with marks. They also divide the line into bands of color, as on the hodographs of
// the Weather Service.
Edges edges_of(const Units& units) {
    if (facts_of(units.height).si < 400) {  // feet
        constexpr double kft_m = 304.8;
        return {3 * kft_m, 10 * kft_m, 20 * kft_m, 30 * kft_m};
    }
    return {1'000, 3'000, 6'000, 9'000};
}

std::size_t band_of(double height_m, const Units& units) {
    const Edges edges = edges_of(units);
    return static_cast<std::size_t>(std::ranges::upper_bound(edges, height_m) - edges.begin());
}

Rgba8 band_color(std::size_t band, Theme theme) {
    constexpr std::array<Rgba8, band_count> on_dark = {{{232, 92, 224, 255},
                                                        {255, 96, 80, 255},
                                                        {84, 204, 98, 255},
                                                        {250, 206, 66, 255},
                                                        {92, 190, 250, 255}}};
    constexpr std::array<Rgba8, band_count> on_light = {{{176, 32, 168, 255},
                                                         {208, 44, 30, 255},
                                                         {20, 132, 44, 255},
                                                         {176, 118, 0, 255},
                                                         {16, 104, 190, 255}}};
    return (theme == Theme::dark ? on_dark : on_light)[band];
}

struct NamedMotion {
    const char* mark;
    const char* name;
    Motion motion;
};
std::vector<NamedMotion> motions_shown(const Result<StormMotions>& motions) {
    if (!motions) return {};
    return {{"RM", "right mover", motions->right},
            {"LM", "left mover", motions->left},
            {"MW", "mean wind", motions->mean}};
}

std::vector<const WindLayer*> layers_with_wind(const WindColumn& column) {
    std::vector<const WindLayer*> found;
    for (const WindLayer& layer : column.layers)
        if (layer.wind) found.push_back(&layer);
    return found;
}

class Hodograph {
  public:
    Hodograph(const WindPage& page, const WindColumn& column, const Result<StormMotions>& motions,
              const Fonts& fonts)
        : page_(page),
          column_(column),
          layers_(layers_with_wind(column)),
          motions_(motions),
          speed_(facts_of(page.units.speed)),
          plan_(plan_hodograph(page, column, motions)),
          on_(page, fonts),
          scale_(on_.scale()) {}

    Image draw() {
        on_.write_title(page_.station + " hodograph",
                        minute_text(column_.time) + "  \u00B7  " + page_.method);
        const Rect& plot = plan_.plot;
        on_.canvas().clip({{plot.x, plot.y},
                           {plot.right(), plot.y},
                           {plot.right(), plot.bottom()},
                           {plot.x, plot.bottom()}});
        draw_rings();
        draw_line();
        draw_heights();
        draw_motions();
        on_.canvas().unclip();
        on_.canvas().line({{plot.x, plot.y},
                           {plot.right(), plot.y},
                           {plot.right(), plot.bottom()},
                           {plot.x, plot.bottom()}},
                          scale_, on_.shades().border, true);
        write_heights();
        write_motions();
        return on_.canvas().image();
    }

  private:
    void draw_rings() {
        const Rect& plot = plan_.plot;
        const Shades& shades = on_.shades();
        on_.canvas().line({{plot.x, plan_.calm.y}, {plot.right(), plan_.calm.y}}, scale_,
                          shades.ring, false);
        on_.canvas().line({{plan_.calm.x, plot.y}, {plan_.calm.x, plot.bottom()}}, scale_,
                          shades.ring, false);
        const double farthest = std::hypot(plot.width, plot.height) / plan_.px_per_mps;
        for (int i = 1; i * plan_.ring_step_mps < farthest; ++i) {
            const double radius = i * plan_.ring_step_mps * plan_.px_per_mps;
            std::vector<Point> ring;
            for (int k = 0; k < 180; ++k)
                ring.push_back({plan_.calm.x + radius * std::sin(2 * k * degree),
                                plan_.calm.y - radius * std::cos(2 * k * degree)});
            on_.canvas().line(ring, scale_, shades.ring, true);
        }
        write_rings(static_cast<int>(farthest / plan_.ring_step_mps));
    }

    // Writes the speeds of the rings, in the direction from calm in which the plot has the most
    // rings.
    void write_rings(int rings) {
        std::vector<Point> most;
        for (const Point& toward : {Point{0, 1}, {0, -1}, {-1, 0}, {1, 0}}) {
            std::vector<Point> shown;
            for (int i = 1; i <= rings; ++i) {
                const double away = i * plan_.ring_step_mps * plan_.px_per_mps;
                const Point at{plan_.calm.x + away * toward.x, plan_.calm.y + away * toward.y};
                if (is_inside(at, 20 * scale_)) shown.push_back(at);
            }
            if (shown.size() > most.size()) most = shown;
        }
        for (const Point& at : most) {
            const double speed =
                std::hypot(at.x - plan_.calm.x, at.y - plan_.calm.y) / plan_.px_per_mps;
            on_.write(fmt::format("{} {}", number_text(speed / speed_.si, 3), speed_.symbol),
                      {at.x, at.y + 3.5 * scale_},
                      {.size = 10, .is_quiet = true, .share = 0.5, .has_halo = true});
        }
    }

    [[nodiscard]] bool is_inside(Point at, double margin) const {
        const Rect& plot = plan_.plot;
        return at.x >= plot.x + margin && at.x <= plot.right() - margin &&
               at.y >= plot.y + margin && at.y <= plot.bottom() - margin;
    }

    // Draws the line from layer to layer. Each piece has the color of its height. Pieces over a
    // gap, and pieces that end at birds, are thin. A wide gap stays open.
    void draw_line() {
        for (std::size_t i = 1; i < layers_.size(); ++i) {
            const WindLayer& low = *layers_[i - 1];
            const WindLayer& high = *layers_[i];
            const double gap = high.middle_m() - low.middle_m();
            if (gap > widest_gap_m) continue;
            const bool is_sure = gap <= most_gap_m && low.wind->birds != retrieve::Birds::likely &&
                                 high.wind->birds != retrieve::Birds::likely;
            const double middle = (low.middle_m() + high.middle_m()) / 2;
            on_.canvas().line({plan_.at(low.wind->motion), plan_.at(high.wind->motion)},
                              (is_sure ? 3 : 1) * scale_,
                              hodograph_color(middle, page_.units, page_.theme), false);
        }
        for (const WindLayer* layer : layers_)
            on_.disc(plan_.at(layer->wind->motion), 1.8 * scale_,
                     hodograph_color(layer->middle_m(), page_.units, page_.theme));
    }

    void draw_heights() {
        for (const double height : edges_of(page_.units)) {
            const auto above = std::ranges::find_if(
                layers_, [&](const WindLayer* layer) { return layer->middle_m() >= height; });
            if (above == layers_.begin() || above == layers_.end()) continue;
            const WindLayer& low = **(above - 1);
            const WindLayer& high = **above;
            if (high.middle_m() - low.middle_m() > most_gap_m) continue;
            const double part = (height - low.middle_m()) / (high.middle_m() - low.middle_m());
            const Point from = plan_.at(low.wind->motion), to = plan_.at(high.wind->motion);
            const Point at{from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
            on_.disc(at, 5.5 * scale_, on_.shades().page);
            on_.disc(at, 4.3 * scale_, on_.shades().text);
            on_.write(number_text(height / facts_of(page_.units.height).si, 3),
                      {at.x + 8 * scale_, at.y - 5 * scale_},
                      {.size = 12, .is_bold = true, .has_halo = true});
        }
    }

    void draw_motions() {
        for (const NamedMotion& one : motions_shown(motions_)) {
            const Point at = plan_.at(one.motion);
            const double arm = 6 * scale_;
            for (const bool is_halo : {true, false}) {
                const double line = (is_halo ? 5 : 2) * scale_;
                const Rgba8 color = is_halo ? on_.shades().halo : on_.shades().text;
                on_.canvas().line({{at.x - arm, at.y}, {at.x + arm, at.y}}, line, color, false);
                on_.canvas().line({{at.x, at.y - arm}, {at.x, at.y + arm}}, line, color, false);
            }
            on_.write(one.mark, {at.x + 8 * scale_, at.y + 14 * scale_},
                      {.size = 12, .is_bold = true, .has_halo = true});
        }
    }

    [[nodiscard]] double motions_left() const { return page_.width * 0.42; }

    // Writes the key of the colors below the plot, at the left.
    void write_heights() {
        const double left = plan_.plot.x, top = plan_.plot.bottom();
        const UnitFacts& height = facts_of(page_.units.height);
        const double room = motions_left() - left - 10 * scale_;
        on_.write(fmt::format("Height above the radar, {}", height.symbol),
                  {left, top + 16 * scale_}, {.size = 11, .is_bold = true, .room = room});
        const Edges edges = edges_of(page_.units);
        for (std::size_t band = 0; band < band_count; ++band) {
            const double row = top + (31 + 14.0 * static_cast<double>(band)) * scale_;
            on_.canvas().fill(Rect{left, row - 8 * scale_, 18 * scale_, 8 * scale_},
                              band_color(band, page_.theme));
            const auto edge = [&](std::size_t i) { return number_text(edges[i] / height.si, 3); };
            const std::string text = band == band_count - 1 ? "above " + edge(band - 1)
                                     : band == 0            ? "0 to " + edge(0)
                                                            : edge(band - 1) + " to " + edge(band);
            on_.write(text, {left + 24 * scale_, row}, {.size = 11});
        }
    }

    // Writes the storm motions, or the reason why there are none, to the right of the key.
    void write_motions() {
        const double left = motions_left(), top = plan_.plot.bottom();
        const double room = page_.width - left - side_margin_px * scale_;
        const auto row = [&](int number) { return top + (16 + 15 * number) * scale_; };
        int next = 1;
        on_.write(fmt::format("Storm motion, from degrees / {}", speed_.symbol), {left, row(0)},
                  {.size = 11, .is_bold = true, .room = room});
        for (const NamedMotion& one : motions_shown(motions_)) {
            on_.write(fmt::format("{}  {} {:.0f}\u00B0 / {:.0f}", one.mark, one.name,
                                  one.motion.direction_deg(), one.motion.speed_mps() / speed_.si),
                      {left, row(next++)}, {.size = 11, .room = room});
        }
        if (!motions_)
            on_.write("none: " + motions_.error().message, {left, row(next++)},
                      {.size = 11, .room = room});
        on_.write(fmt::format("Rings every {} {}", number_text(plan_.ring_step_mps / speed_.si, 3),
                              speed_.symbol),
                  {left, row(next++)}, {.size = 11, .is_quiet = true, .room = room});
        on_.write(errors_text(), {left, row(next++)}, {.size = 11, .is_quiet = true, .room = room});
    }

    [[nodiscard]] std::string errors_text() const {
        if (layers_.empty()) return "No layer has a wind";
        double least = 1e9, most = 0;
        for (const WindLayer* layer : layers_) {
            const double error =
                std::max(layer->wind->u_error_mps, layer->wind->v_error_mps) / speed_.si;
            least = std::min(least, error);
            most = std::max(most, error);
        }
        return fmt::format("Standard errors {:.1f} to {:.1f} {}", least, most, speed_.symbol);
    }

    const WindPage& page_;
    const WindColumn& column_;
    std::vector<const WindLayer*> layers_;
    const Result<StormMotions>& motions_;
    const UnitFacts& speed_;
    HodographPlan plan_;
    WindCanvas on_;
    double scale_;
};

}  // namespace

Rgba8 hodograph_color(double height_m, const Units& units, Theme theme) {
    return band_color(band_of(height_m, units), theme);
}

HodographPlan plan_hodograph(const WindPage& page, const WindColumn& column,
                             const Result<StormMotions>& motions) {
    std::vector<Motion> shown = {{}};
    for (const WindLayer* layer : layers_with_wind(column))
        shown.push_back(layer->wind->motion);
    for (const NamedMotion& one : motions_shown(motions))
        shown.push_back(one.motion);
    const auto [left, right] = std::ranges::minmax(shown, {}, &Motion::u_mps);
    const auto [bottom, top] = std::ranges::minmax(shown, {}, &Motion::v_mps);
    const double width = std::max(right.u_mps - left.u_mps, least_span_mps) * 1.3;
    const double height = std::max(top.v_mps - bottom.v_mps, least_span_mps) * 1.3;
    HodographPlan plan;
    const double scale = WindCanvas::scale_of(page);
    plan.plot = {side_margin_px * scale, title_height_px * scale,
                 std::max(page.width - 2 * side_margin_px * scale, 1.0),
                 std::max(page.height - (title_height_px + key_height_px) * scale, 1.0)};
    plan.px_per_mps = std::min(plan.plot.width / width, plan.plot.height / height);
    plan.calm = {
        plan.plot.x + plan.plot.width / 2 - (left.u_mps + right.u_mps) / 2 * plan.px_per_mps,
        plan.plot.y + plan.plot.height / 2 + (bottom.v_mps + top.v_mps) / 2 * plan.px_per_mps};
    const double unit = facts_of(page.units.speed).si;
    const double range = std::max(plan.plot.width, plan.plot.height) / plan.px_per_mps;
    plan.ring_step_mps = round_step(range / unit, most_rings_shown) * unit;
    return plan;
}

Image draw_hodograph(const WindPage& page, const WindColumn& column,
                     const Result<StormMotions>& motions, const Fonts& fonts) {
    return Hodograph(page, column, motions, fonts).draw();
}

}  // namespace stormcellar::render

// Draws the picture of a vertical section with its axes.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/image/round_step.h"
#include "render/image/shades.h"
#include "render/products/section.h"
#include "render/view/length_text.h"

namespace stormcellar::render {
namespace {

class Axes {
  public:
    Axes(Canvas& canvas, const Fonts& fonts, const Section& section, const SectionPlace& place,
         const GroundLook& look, const Units& units, int picture_width)
        : canvas_(canvas),
          fonts_(fonts),
          section_(section),
          distance_(facts_of(units.distance)),
          height_(facts_of(units.height)),
          shades_(*look.shades),
          scale_(look.scale),
          picture_width_(picture_width) {
        left_ = place.left;
        right_ = place.left + place.width;
        top_ = place.top;
        bottom_ = place.top + place.height;
    }

    void draw() {
        canvas_.line({{left_, top_}, {right_, top_}, {right_, bottom_}, {left_, bottom_}}, scale_,
                     shades_.border, true);
        draw_heights();
        draw_distances();
        draw_ends();
        const double across = section_.length_m / (right_ - left_);
        const double up = (section_.top_m - section_.bottom_m) / (bottom_ - top_);
        put(fmt::format("Height above sea level, {}  \u00B7  vertical \u00D7{:.3g}", height_.symbol,
                        across / up),
            left_, top_ - 9 * scale_, 0, false);
    }

  private:
    // Draws a text so that `share` of its width is left of x. If it would leave the picture at the
    // right, it moves to the left.
    void put(const std::string& text, double x, double baseline, double share, bool strong) {
        const double size = 10 * scale_;
        const double width = fonts_.width(text, size, strong);
        const double left = std::min(x - share * width, picture_width_ - width - 3 * scale_);
        canvas_.text(fonts_, text, {left, baseline}, size, strong,
                     strong ? shades_.text : shades_.quiet_text);
    }

    void draw_heights() {
        const double range = (section_.top_m - section_.bottom_m) / height_.si;
        const double bottom = section_.bottom_m / height_.si;
        const int most = std::max(2, static_cast<int>((bottom_ - top_) / (28 * scale_)));
        const double step = round_step(range, most);
        for (int i = static_cast<int>(std::ceil(bottom / step - 1e-9)); i * step <= bottom + range;
             ++i) {
            const double y = bottom_ - (i * step - bottom) / range * (bottom_ - top_);
            canvas_.line({{left_ - 4 * scale_, y}, {left_, y}}, scale_, shades_.border, false);
            if (i != 0) canvas_.line({{left_, y}, {right_, y}}, scale_, faint(), false);
            put(number_text(i * step), left_ - 7 * scale_, y + 3.5 * scale_, 1, false);
        }
    }

    void draw_distances() {
        const double length = section_.length_m / distance_.si;
        const int most = std::max(2, static_cast<int>((right_ - left_) / (60 * scale_)));
        const double step = round_step(length, most);
        for (int i = 0; i * step <= length * (1 + 1e-9); ++i) {
            const double x = left_ + i * step / length * (right_ - left_);
            canvas_.line({{x, bottom_}, {x, bottom_ + 4 * scale_}}, scale_, shades_.border, false);
            const bool last = (i + 1) * step > length * (1 + 1e-9);
            put(number_text(i * step) + (last ? fmt::format(" {}", distance_.symbol) : ""), x,
                bottom_ + 16 * scale_, 0.5, false);
        }
    }

    void draw_ends() {
        const double baseline = bottom_ + 36 * scale_;
        const std::string from = "A  " + place_text(section_.line.from);
        const std::string to = place_text(section_.line.to) + "  B";
        put(from, left_, baseline, 0, true);
        // Leave out the text of the second end if there is no room for both.
        const double room = right_ - left_;
        const double size = 10 * scale_;
        if (fonts_.width(from + to, size, true) + 12 * scale_ <= room) {
            put(to, right_, baseline, 1, true);
        }
    }

    [[nodiscard]] Rgba8 faint() const {
        Rgba8 color = shades_.border;
        color[3] = 44;
        return color;
    }

    Canvas& canvas_;
    const Fonts& fonts_;
    const Section& section_;
    const UnitFacts& distance_;
    const UnitFacts& height_;
    const Shades& shades_;
    double scale_;
    double picture_width_;
    double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;
};

}  // namespace

std::string place_text(grid::GeoPoint point) {
    point.longitude_deg = std::remainder(point.longitude_deg, 360.0);
    return fmt::format("{:.3f}\u00B0{} {:.3f}\u00B0{}", std::abs(point.latitude_deg),
                       point.latitude_deg < 0 ? 'S' : 'N', std::abs(point.longitude_deg),
                       point.longitude_deg < 0 ? 'W' : 'E');
}

Image draw_section(const Section& section, const ColorTable& table, const SectionPlace& place,
                   int width, int height, const GroundLook& look, const Units& units,
                   const Fonts* fonts, int threads) {
    Image image(width, height, look.shades->page);
    for_each_piece(place.height, threads, [&](int y) {
        for (int x = 0; x < place.width; ++x) {
            if (section.in_grid[static_cast<std::size_t>(x)] == 0) continue;
            const std::size_t cell = section.field.index(x, place.height - 1 - y);
            image.set(
                place.left + x, place.top + y,
                shade_of(section.field, cell, table, {place.left + x, place.top + y, 0}, look));
        }
    });
    if (fonts == nullptr) return image;
    Canvas canvas(image);
    Axes(canvas, *fonts, section, place, look, units, width).draw();
    return canvas.image();
}

}  // namespace stormcellar::render

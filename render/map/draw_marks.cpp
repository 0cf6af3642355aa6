#include "render/map/draw_marks.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"
#include "render/view/length_text.h"

namespace stormcellar::render {
namespace {

Point moved(const MapLines& lines, Point p) {
    return {p.x + lines.left, p.y + lines.top};
}

void draw_texts(Canvas& canvas, const Fonts& fonts, const MapLines& lines,
                const std::vector<MarkText>& texts) {
    for (const MarkText& text : texts) {
        canvas.text(fonts, text.text, moved(lines, text.left_baseline), text.size, text.bold,
                    text.color, lines.shades->halo);
    }
}

std::vector<Point> circle_about(Point middle, double radius) {
    std::vector<Point> circle;
    for (int i = 0; i < 16; ++i) {
        const double turn = i * 22.5 * degree;
        circle.push_back({middle.x + radius * std::sin(turn), middle.y - radius * std::cos(turn)});
    }
    return circle;
}

void draw_heights(Canvas& canvas, const Fonts& fonts, const MapLines& lines,
                  const MapMarks& marks) {
    if (!marks.heights) return;
    const HeightScale& heights = *marks.heights;
    canvas.line({moved(lines, heights.bottom), moved(lines, heights.top)}, lines.scale,
                lines.shades->border, false);
    for (const Point& tick : heights.ticks) {
        const Point at = moved(lines, tick);
        canvas.line({at, {at.x + heights.side * 4 * lines.scale, at.y}}, lines.scale,
                    lines.shades->border, false);
    }
    draw_texts(canvas, fonts, lines, marks.height_texts);
}

// Turns directions on the ground into directions in the picture, at its middle. A unit circle of
// the ground becomes an ellipse, which is scaled so that its long axis is 1.
class GroundTurn {
  public:
    explicit GroundTurn(const ViewGeometry& geometry) {
        const auto middle = geometry.ground({0.5 * geometry.width(), 0.5 * geometry.height()});
        const GroundPoint at = middle.value_or(GroundPoint{});
        const double step = 0.001 * std::max(geometry.half_x_m(), geometry.half_y_m());
        const auto slope = [&](double dx, double dy) {
            const double h = geometry.ground_m();
            const Pixel one = geometry.project(at.x_m - dx * step, at.y_m - dy * step, h);
            const Pixel two = geometry.project(at.x_m + dx * step, at.y_m + dy * step, h);
            return Point{two.x - one.x, two.y - one.y};
        };
        east_ = slope(1, 0);
        north_ = slope(0, 1);
        // Computes the larger singular value of the matrix of slopes.
        const double squares =
            east_.x * east_.x + east_.y * east_.y + north_.x * north_.x + north_.y * north_.y;
        const double area = east_.x * north_.y - east_.y * north_.x;
        const double longest = std::sqrt(
            (squares + std::sqrt(std::max(0.0, squares * squares - 4 * area * area))) / 2);
        visible_ = std::isfinite(longest) && longest > 0;
        scale_ = visible_ ? 1 / longest : 0;
    }

    [[nodiscard]] bool is_visible() const { return visible_; }
    [[nodiscard]] Point towards(double azimuth_deg) const {
        const double x = std::sin(azimuth_deg * degree) * scale_;
        const double y = std::cos(azimuth_deg * degree) * scale_;
        return {x * east_.x + y * north_.x, x * east_.y + y * north_.y};
    }

  private:
    Point east_, north_;
    double scale_ = 0;
    bool visible_ = false;
};

void draw_north(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const Rect& box) {
    const GroundTurn turn(*lines.geometry);
    if (!turn.is_visible()) return;
    const double radius = (box.width - 8 * lines.scale) / 2;
    const Point middle = moved(lines, {box.x + box.width / 2, box.y + 18 * lines.scale + radius});
    const auto towards = [&](double azimuth_deg, double length) {
        const Point unit = turn.towards(azimuth_deg);
        return Point{middle.x + length * unit.x, middle.y + length * unit.y};
    };
    std::vector<Point> circle;
    circle.reserve(72);
    for (int i = 0; i < 72; ++i)
        circle.push_back(towards(i * 5.0, radius));
    Rgba8 disc = lines.shades->page;
    disc[3] = 170;
    canvas.fill(circle, disc);
    canvas.line(circle, lines.scale, lines.shades->border, true);
    canvas.fill({towards(0, radius), towards(150, 0.55 * radius), towards(180, 0.2 * radius),
                 towards(210, 0.55 * radius)},
                lines.shades->text);
    const double size = 11 * lines.scale;
    const Point n = towards(0, radius + 9 * lines.scale);
    const double apart = n.y < middle.y ? std::min(n.y, middle.y - 9 * lines.scale) : n.y;
    canvas.text(fonts, "N", {n.x - fonts.width("N", size, true) / 2, apart + 0.36 * size}, size,
                true, lines.shades->text, lines.shades->halo);
}

void draw_scale_bar(Canvas& canvas, const Fonts& fonts, const MapLines& lines,
                    const ScaleBar& bar) {
    const Point left = moved(lines, {bar.left.x + 0.5, bar.left.y + 0.5});
    const Point right = {left.x + bar.length, left.y};
    const double up = 4 * lines.scale;
    const std::vector<Point> shape = {{left.x, left.y - up}, left, right, {right.x, right.y - up}};
    canvas.line(shape, 3.4 * lines.scale, lines.shades->halo, false);
    canvas.line(shape, 1.2 * lines.scale, lines.shades->text, false);
    const double size = 10 * lines.scale;
    canvas.text(fonts, distance_text(bar.metres, lines.units),
                {left.x + 3 * lines.scale, left.y - 4 * lines.scale}, size, false,
                lines.shades->text, lines.shades->halo);
}

}  // namespace

void draw_marks(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const MapMarks& marks) {
    clip_to_picture(canvas, lines);
    draw_heights(canvas, fonts, lines, marks);
    draw_shape_marks(canvas, marks.shapes, lines);
    draw_cell_marks(canvas, marks.cells, lines);
    for (const Point& city : marks.cities) {
        canvas.fill(circle_about(moved(lines, city), 2.6 * lines.scale), lines.shades->halo);
        canvas.fill(circle_about(moved(lines, city), 1.6 * lines.scale), lines.shades->city);
    }
    // With many sites, draw smaller marks.
    const double size = marks.sites.size() > 1 ? 0.75 : 1;
    for (const Point& site : marks.sites) {
        const Point at = moved(lines, site);
        for (const auto& [half, color] :
             {std::pair{3.8, lines.shades->halo}, std::pair{2.4, lines.shades->text}}) {
            const double r = size * half * lines.scale;
            canvas.fill({{at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}},
                        color);
        }
    }
    draw_texts(canvas, fonts, lines, marks.ground_texts);
    draw_texts(canvas, fonts, lines, marks.site_texts);
    for (const ShapeMark& mark : marks.shapes)
        if (mark.label) draw_texts(canvas, fonts, lines, {*mark.label});
    // The label of a strong cell is over those of weaker cells.
    for (auto mark = marks.cells.rbegin(); mark != marks.cells.rend(); ++mark)
        if (mark->label) draw_texts(canvas, fonts, lines, {*mark->label});
    draw_north(canvas, fonts, lines, marks.north);
    if (marks.scale_bar) draw_scale_bar(canvas, fonts, lines, *marks.scale_bar);
    canvas.unclip();
}

}  // namespace stormcellar::render

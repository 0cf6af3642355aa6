#include "render/map/shape_marks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/degree.h"
#include "render/color/color_difference.h"
#include "render/map/map_ground.h"

namespace stormcellar::render {
namespace {

// Lengths at scale 1, in pixels.
constexpr double dot_radius = 3;
constexpr double halo_room = 1;
constexpr double label_size = 10;
// Edges are split into parts of at most this length, because they are not straight on the map.
constexpr double longest_part_deg = 0.25;
constexpr int most_parts = 200'000;  // of all edges
// Edges may be this far beyond the grid.
constexpr double near_deg = 10;
constexpr double meters_a_degree = 111e3;
// Points farther away than this count as not seen.
constexpr double most_pixels = 1e5;

class ShapePlanner {
  public:
    ShapePlanner(const MapLines& lines, LabelPlaces& places)
        : lines_(lines), places_(places), ground_(*lines.spec) {}

    std::vector<ShapeMark> plan(const Fonts* fonts) {
        std::vector<ShapeMark> marks;
        for (const OverlayShape& shape : lines_.shapes->shapes) {
            if (!shape.is_in_force(lines_.time) || shape.points.empty()) continue;
            ShapeMark mark;
            mark.color = shape.color.value_or(lines_.shades->text);
            mark.width = static_cast<double>(shape.width);
            if (shape.points.size() > 1) {
                mark.lines = seen_lines(shape.points);
            } else {
                mark.dot = pixel(shape.points.front());
                if (!mark.dot || !is_in_picture(*mark.dot)) continue;
                const double r = scaled(dot_radius + halo_room);
                places_.take({mark.dot->x - r, mark.dot->y - r, 2 * r, 2 * r});
                if (fonts != nullptr && !shape.label.empty()) plan_label(*fonts, shape, mark);
            }
            marks.push_back(std::move(mark));
        }
        return marks;
    }

  private:
    [[nodiscard]] double scaled(double length) const { return length * lines_.scale; }

    [[nodiscard]] std::optional<Point> pixel(grid::GeoPoint place) const {
        const GroundPoint at = ground_.ground(place);
        const Pixel found = lines_.geometry->project(at.x_m, at.y_m, lines_.geometry->ground_m());
        const bool is_near = std::abs(found.x) < most_pixels && std::abs(found.y) < most_pixels;
        if (!is_near) return std::nullopt;  // also for a place that is not seen, which is NaN
        return Point{found.x, found.y};
    }
    [[nodiscard]] bool is_in_picture(Point p) const {
        return p.x >= 0 && p.y >= 0 && p.x <= lines_.geometry->width() &&
               p.y <= lines_.geometry->height();
    }

    // Returns true if an edge may be in the picture: if it meets the surroundings of the grid.
    [[nodiscard]] bool is_near(grid::GeoPoint from, double north_deg, double east_deg) const {
        const grid::GridSpec& spec = *lines_.spec;
        const double reach_deg =
            near_deg + std::max(spec.nx * spec.cell_width_m(), spec.ny * spec.cell_height_m()) /
                           meters_a_degree;
        const auto meets = [](double begin, double length, double reach) {
            return std::min(begin, begin + length) < reach &&
                   std::max(begin, begin + length) > -reach;
        };
        if (!meets(from.latitude_deg - spec.center_latitude_deg, north_deg, reach_deg))
            return false;
        const double shrink = std::max(0.1, std::cos(spec.center_latitude_deg * degree));
        const double begin_deg =
            std::remainder(from.longitude_deg - spec.center_longitude_deg, 360);
        return std::ranges::any_of(std::array{-360.0, 0.0, 360.0}, [&](double turn_deg) {
            return meets(begin_deg + turn_deg, east_deg, reach_deg / shrink);
        });
    }

    // Returns the number of parts into which an edge is split. Returns 1 if most_parts does not
    // allow the edge's parts.
    [[nodiscard]] int parts_of(double north_deg, double east_deg) {
        const double length_deg = std::max(std::abs(north_deg), std::abs(east_deg));
        const int parts = std::max(1, static_cast<int>(std::ceil(length_deg / longest_part_deg)));
        if (parts > parts_left_) return 1;
        parts_left_ -= parts - 1;
        return parts;
    }

    // Returns the parts of a line that the camera sees.
    [[nodiscard]] std::vector<std::vector<Point>> seen_lines(
        const std::vector<grid::GeoPoint>& places) {
        std::vector<std::vector<Point>> all(1);
        const auto add = [&](grid::GeoPoint place) {
            if (const auto p = pixel(place)) {
                all.back().push_back(*p);
            } else if (!all.back().empty()) {
                all.emplace_back();
            }
        };
        add(places.front());
        for (std::size_t i = 1; i < places.size(); ++i) {
            const grid::GeoPoint from = places[i - 1];
            const double north_deg = places[i].latitude_deg - from.latitude_deg;
            const double east_deg =
                std::remainder(places[i].longitude_deg - from.longitude_deg, 360);
            if (!is_near(from, north_deg, east_deg)) {
                all.emplace_back();
                add(places[i]);
                continue;
            }
            const int parts = parts_of(north_deg, east_deg);
            for (int part = 1; part <= parts; ++part) {
                const double share = static_cast<double>(part) / parts;
                add({from.latitude_deg + share * north_deg, from.longitude_deg + share * east_deg});
            }
        }
        std::erase_if(all, [](const auto& line) { return line.size() < 2; });
        return all;
    }

    void plan_label(const Fonts& fonts, const OverlayShape& shape, ShapeMark& mark) {
        const MarkTextLook look{scaled(label_size), true, lines_.shades->text, scaled(1)};
        const double width = fonts.width(shape.label, look.size, look.bold);
        const double apart = scaled(dot_radius + 3);
        const double level = mark.dot->y + 0.36 * look.size;
        const double middle = mark.dot->x - width / 2;
        for (const Point& corner :
             {Point{mark.dot->x + apart, level}, Point{mark.dot->x - apart - width, level},
              Point{middle, mark.dot->y - apart},
              Point{middle, mark.dot->y + apart + 0.8 * look.size}}) {
            mark.label = claim_text(places_, fonts, shape.label, corner, look);
            if (mark.label) return;
        }
    }

    const MapLines& lines_;
    LabelPlaces& places_;
    GroundMap ground_;
    int parts_left_ = most_parts;
};

std::vector<Point> outline_of_dot(Point center, double radius) {
    std::vector<Point> circle;
    for (int i = 0; i < 24; ++i) {
        const double turn = i * 15 * degree;
        circle.push_back({center.x + radius * std::cos(turn), center.y + radius * std::sin(turn)});
    }
    return circle;
}

// Returns the color of halos or of letters, whichever differs more in lightness. So a dark line has
// a light halo on a dark map.
Rgba8 halo_of(Rgba8 color, const Shades& shades) {
    const double lightness = lab_of(color).lightness;
    const auto distance = [lightness](Rgba8 other) {
        return std::abs(lab_of(other).lightness - lightness);
    };
    Rgba8 halo = distance(shades.halo) < distance(shades.text) ? shades.text : shades.halo;
    halo[3] = 255;  // halos that overlap are no darker
    return halo;
}

}  // namespace

std::vector<ShapeMark> plan_shape_marks(const Fonts* fonts, const MapLines& lines,
                                        LabelPlaces& places) {
    if (lines.shapes == nullptr) return {};
    return ShapePlanner(lines, places).plan(fonts);
}

void draw_shape_marks(Canvas& canvas, const std::vector<ShapeMark>& marks, const MapLines& lines) {
    const Point offset = {lines.left, lines.top};
    for (const ShapeMark& mark : marks) {
        const Rgba8 halo = halo_of(mark.color, *lines.shades);
        for (const auto& [room, color] : {std::pair{halo_room, halo}, std::pair{0.0, mark.color}}) {
            for (const std::vector<Point>& line : mark.lines)
                canvas.add_to_path(line, offset);
            if (!mark.lines.empty()) canvas.draw_path((mark.width + 2 * room) * lines.scale, color);
            if (!mark.dot) continue;
            const Point at = {mark.dot->x + offset.x, mark.dot->y + offset.y};
            canvas.fill(outline_of_dot(at, (dot_radius + room) * lines.scale), color);
        }
    }
}

}  // namespace stormcellar::render

#include "render/map/map_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/projection.h"
#include "render/shades.h"

namespace stormcellar::render {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr int ring_points = 240;
constexpr double text_size = 10;

// A site and what lies about it, in metres of the picture's ground.
class SiteMap {
  public:
    SiteMap(const grid::GridSpec& spec, const grid::SitePosition& site)
        : spec_(spec),
          projection_(spec),
          frame_(site.latitude_deg, site.longitude_deg),
          site_(point({site.latitude_deg, site.longitude_deg})) {}

    [[nodiscard]] GroundPoint site() const { return site_; }

    // An azimuthal equidistant map shows a ring as a circle, near enough; others do not.
    [[nodiscard]] GroundPoint about(double azimuth_rad, double arc_m) const {
        if (spec_.projection == grid::Projection::azimuthal_equidistant) {
            return {site_.x_m + arc_m * std::sin(azimuth_rad),
                    site_.y_m + arc_m * std::cos(azimuth_rad)};
        }
        return point(frame_.to_geo({azimuth_rad / radians, arc_m}));
    }

  private:
    [[nodiscard]] GroundPoint point(grid::GeoPoint place) const {
        const grid::ColumnPoint column = projection_.to_column(place);
        return {(column.x - 0.5 * (spec_.nx - 1)) * spec_.cell_width_m(),
                (column.y - 0.5 * (spec_.ny - 1)) * spec_.cell_height_m()};
    }

    const grid::GridSpec& spec_;
    grid::GridProjection projection_;
    grid::SiteFrame frame_;
    GroundPoint site_;
};

Point on_canvas(const MapLines& lines, double x_m, double y_m, double height_m) {
    const Pixel p = lines.geometry->project(x_m, y_m, height_m);
    return {p.x + lines.left, p.y + lines.top};
}

Point on_ground(const MapLines& lines, GroundPoint p) {
    return on_canvas(lines, p.x_m, p.y_m, lines.geometry->ground_m());
}

std::vector<GroundPoint> corners(const MapLines& lines) {
    const double x = lines.geometry->half_x_m();
    const double y = lines.geometry->half_y_m();
    return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

std::vector<Point> ground_polygon(const MapLines& lines) {
    std::vector<Point> polygon;
    for (const GroundPoint& corner : corners(lines))
        polygon.push_back(on_ground(lines, corner));
    return polygon;
}

bool inside_grid(const MapLines& lines, GroundPoint p) {
    return std::abs(p.x_m) < lines.geometry->half_x_m() &&
           std::abs(p.y_m) < lines.geometry->half_y_m();
}

bool inside_picture(const MapLines& lines, Point p, double margin) {
    return p.x >= lines.left + margin && p.y >= lines.top + margin &&
           p.x <= lines.left + lines.geometry->width() - margin &&
           p.y <= lines.top + lines.geometry->height() - margin;
}

void draw_ring(Canvas& canvas, const MapLines& lines, const SiteMap& map, double radius_m) {
    std::vector<Point> ring;
    ring.reserve(ring_points);
    for (int i = 0; i < ring_points; ++i) {
        const double turn = 2 * std::numbers::pi * i / ring_points;
        ring.push_back(on_ground(lines, map.about(turn, radius_m)));
    }
    canvas.line(ring, lines.scale, shades::ring, true);
}

// Distances stand on the rings where they come nearest to the viewer.
void label_rings(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const SiteMap& map) {
    const double size = text_size * lines.scale;
    Point last = on_ground(lines, map.site());
    for (int i = 1; i <= 40; ++i) {
        const double radius = i * lines.ring_spacing_m;
        const GroundPoint p = map.about(lines.camera.azimuth_deg * radians, radius);
        const Point at = on_ground(lines, p);
        if (!inside_grid(lines, p) || !inside_picture(lines, at, 2 * size)) return;
        if (std::abs(at.y - last.y) < 1.6 * size) continue;
        last = at;
        const std::string text = fmt::format("{:g} km", radius / 1000);
        canvas.text(fonts, text, {at.x - fonts.width(text, size, false) / 2, at.y + 0.36 * size},
                    size, false, shades::quiet_text, shades::halo);
    }
}

// The upright edge of the box that is leftmost in the picture is an outline of the box: no echo
// is ever behind it.
void draw_heights(Canvas& canvas, const Fonts& fonts, const MapLines& lines) {
    const ViewGeometry& geometry = *lines.geometry;
    const auto depth = [&](const GroundPoint& p) {
        return p.x_m * geometry.forward()[0] + p.y_m * geometry.forward()[1];
    };
    GroundPoint edge = corners(lines).front();
    for (const GroundPoint& corner : corners(lines)) {
        const double further_left = on_ground(lines, edge).x - on_ground(lines, corner).x;
        if (further_left > 0.5 || (further_left > -0.5 && depth(corner) > depth(edge))) {
            edge = corner;
        }
    }
    const auto at_height = [&](double height_m) {
        return on_canvas(lines, edge.x_m, edge.y_m, height_m);
    };
    const double size = text_size * lines.scale;
    const double km = std::abs(at_height(1000).y - at_height(0).y);
    double step_m = 1000;
    for (const double candidate : {1000.0, 2000.0, 5000.0, 10000.0}) {
        step_m = candidate;
        if (km * step_m / 1000 >= 1.7 * size) break;
    }
    if (km * step_m / 1000 < 1.7 * size) return;
    canvas.line({at_height(geometry.ground_m()), at_height(geometry.top_m())}, lines.scale,
                shades::border, false);
    const int ticks = static_cast<int>(geometry.top_m() / step_m);
    for (int i = 1; i <= ticks; ++i) {
        const double height = i * step_m;
        const Point tick = at_height(height);
        if (!inside_picture(lines, tick, size)) continue;
        const std::string text = fmt::format("{:g} km", height / 1000);
        const double width = fonts.width(text, size, false);
        const bool room = tick.x - lines.left > width + 12 * lines.scale;
        const double side = room ? -1 : 1;
        canvas.line({tick, {tick.x + side * 4 * lines.scale, tick.y}}, lines.scale, shades::border,
                    false);
        canvas.text(fonts, text,
                    {tick.x + side * 7 * lines.scale - (room ? width : 0), tick.y + 0.36 * size},
                    size, false, shades::quiet_text);
    }
}

void draw_north(Canvas& canvas, const Fonts& fonts, const MapLines& lines) {
    const ViewGeometry& geometry = *lines.geometry;
    const double radius = 17 * lines.scale;
    const Point middle = {lines.left + 32 * lines.scale,
                          lines.top + geometry.height() - 34 * lines.scale};
    const auto towards = [&](double azimuth_deg, double length) {
        const double x = std::sin(azimuth_deg * radians);
        const double y = std::cos(azimuth_deg * radians);
        return Point{middle.x + length * (x * geometry.right()[0] + y * geometry.right()[1]),
                     middle.y - length * (x * geometry.up()[0] + y * geometry.up()[1])};
    };
    std::vector<Point> circle;
    circle.reserve(72);
    for (int i = 0; i < 72; ++i)
        circle.push_back(towards(i * 5.0, radius));
    Rgba8 disc = shades::page;
    disc[3] = 170;
    canvas.fill(circle, disc);
    canvas.line(circle, lines.scale, shades::border, true);
    canvas.fill({towards(0, radius), towards(150, 0.55 * radius), towards(180, 0.2 * radius),
                 towards(210, 0.55 * radius)},
                shades::text);
    const double size = 11 * lines.scale;
    const Point n = towards(0, radius + 9 * lines.scale);
    const double apart = n.y < middle.y ? std::min(n.y, middle.y - 9 * lines.scale) : n.y;
    canvas.text(fonts, "N", {n.x - fonts.width("N", size, true) / 2, apart + 0.36 * size}, size,
                true, shades::text, shades::halo);
}

void draw_site(Canvas& canvas, const Fonts& fonts, const MapLines& lines,
               const grid::SitePosition& site) {
    const GroundPoint p = SiteMap(*lines.spec, site).site();
    const Point at = on_ground(lines, p);
    if (!inside_grid(lines, p) || !inside_picture(lines, at, 4 * lines.scale)) return;
    for (const auto& [half, colour] :
         {std::pair{3.5, shades::halo}, std::pair{2.2, shades::text}}) {
        const double r = half * lines.scale;
        canvas.fill({{at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}},
                    colour);
    }
    const double size = text_size * lines.scale;
    canvas.text(fonts, site.icao, {at.x + 6 * lines.scale, at.y - 3 * lines.scale}, size, true,
                shades::text, shades::halo);
}

std::vector<Point> picture_polygon(const MapLines& lines) {
    const double right = lines.left + lines.geometry->width();
    const double bottom = lines.top + lines.geometry->height();
    return {{lines.left, lines.top}, {right, lines.top}, {right, bottom}, {lines.left, bottom}};
}

}  // namespace

double drawn_ring_spacing(const grid::GridSpec& spec, double asked_m) {
    const double reach =
        std::hypot(spec.nx * spec.cell_width_m(), spec.ny * spec.cell_height_m()) / 2;
    double spacing = asked_m;
    while (reach / spacing > 20)
        spacing *= 2;
    return spacing;
}

void draw_border(Canvas& canvas, const MapLines& lines) {
    canvas.clip(picture_polygon(lines));
    canvas.line(ground_polygon(lines), 1.2 * lines.scale, shades::border, true);
    canvas.unclip();
}

void draw_rings(Canvas& canvas, const Fonts& fonts, const MapLines& lines) {
    canvas.clip(picture_polygon(lines));
    if (lines.heights) draw_heights(canvas, fonts, lines);
    canvas.unclip();
    if (lines.sites->size() != 1) return;
    const SiteMap map(*lines.spec, lines.sites->front());
    const GroundPoint site = map.site();
    const double reach = std::hypot(lines.geometry->half_x_m(), lines.geometry->half_y_m()) +
                         std::hypot(site.x_m, site.y_m);
    canvas.clip_both(ground_polygon(lines), picture_polygon(lines));
    for (int i = 1; i * lines.ring_spacing_m < reach && i <= 40; ++i) {
        draw_ring(canvas, lines, map, i * lines.ring_spacing_m);
    }
    label_rings(canvas, fonts, lines, map);
    canvas.unclip();
}

void draw_marks(Canvas& canvas, const Fonts& fonts, const MapLines& lines) {
    canvas.clip(picture_polygon(lines));
    for (const grid::SitePosition& site : *lines.sites)
        draw_site(canvas, fonts, lines, site);
    draw_north(canvas, fonts, lines);
    canvas.unclip();
}

}  // namespace stormcellar::render

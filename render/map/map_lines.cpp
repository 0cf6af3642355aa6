#include "render/map/map_lines.h"

#include <cmath>
#include <numbers>

#include "base/degree.h"
#include "render/map/map_ground.h"
#include "render/view/length_text.h"

namespace stormcellar::render {
namespace {

constexpr int ring_vertices = 240;
constexpr int most_rings = 40;

// A site with its surroundings, in meters on the picture's ground.
class SiteMap {
  public:
    SiteMap(const grid::GridSpec& spec, const grid::SitePosition& site)
        : map_(spec),
          frame_(site.latitude_deg, site.longitude_deg),
          site_(map_.ground({site.latitude_deg, site.longitude_deg})) {}

    [[nodiscard]] GroundPoint site() const { return site_; }

    // Returns the point at an azimuth and a distance from the site. On an azimuthal equidistant map
    // a ring of such points is nearly a circle; on other maps it is not.
    [[nodiscard]] GroundPoint about(double azimuth_rad, double arc_m) const {
        if (grid::facts_of(map_.spec().projection).is_polar) {
            return {site_.x_m + arc_m * std::sin(azimuth_rad),
                    site_.y_m + arc_m * std::cos(azimuth_rad)};
        }
        return map_.ground(frame_.to_geo({azimuth_rad / degree, arc_m}));
    }

  private:
    GroundMap map_;
    grid::SiteFrame frame_;
    GroundPoint site_;
};

std::vector<Point> ring_of(const MapLines& lines, const SiteMap& map, double radius_m) {
    std::vector<Point> ring;
    ring.reserve(ring_vertices);
    for (int i = 0; i < ring_vertices; ++i) {
        const GroundPoint p = map.about(2 * std::numbers::pi * i / ring_vertices, radius_m);
        const Pixel at = lines.geometry->project(p.x_m, p.y_m, lines.geometry->ground_m());
        ring.push_back({at.x, at.y});
    }
    return ring;
}

bool is_finite(Point p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

// Draws a closed line. Leaves out the parts that are not visible.
void draw_closed(Canvas& canvas, const std::vector<Point>& points, const MapLines& lines,
                 double line_width, Rgba8 color) {
    std::vector<Point> run;
    const auto flush = [&] {
        if (run.size() > 1) canvas.add_to_path(run, {lines.left, lines.top});
        run.clear();
    };
    for (std::size_t i = 0; i <= points.size(); ++i) {
        const Point p = points[i % points.size()];
        if (is_finite(p)) {
            run.push_back(p);
        } else {
            flush();
        }
    }
    flush();
    canvas.draw_path(line_width, color);
}

std::vector<Point> ground_outline(const MapLines& lines) {
    // Divide each edge into many parts, because some of them may be visible even if the edge passes
    // the camera.
    constexpr int parts = 32;
    std::vector<Point> outline;
    const auto corners = ground_corners(*lines.geometry);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const GroundPoint& from = corners[c];
        const GroundPoint& to = corners[(c + 1) % corners.size()];
        for (int i = 0; i < parts; ++i) {
            const double share = static_cast<double>(i) / parts;
            const Pixel at = lines.geometry->project(std::lerp(from.x_m, to.x_m, share),
                                                     std::lerp(from.y_m, to.y_m, share),
                                                     lines.geometry->ground_m());
            outline.push_back({at.x, at.y});
        }
    }
    return outline;
}

std::vector<Point> picture_outline(const MapLines& lines) {
    const double right = lines.left + lines.geometry->width();
    const double bottom = lines.top + lines.geometry->height();
    return {{lines.left, lines.top}, {right, lines.top}, {right, bottom}, {lines.left, bottom}};
}

}  // namespace

double drawn_ring_spacing(const grid::GridSpec& spec, const Scene& scene) {
    const double width = spec.nx * spec.cell_width_m();
    const double height = spec.ny * spec.cell_height_m();
    double asked_m = scene.range_ring_spacing_m;
    if (asked_m == Scene::usual_rings) {
        asked_m = 50e3;
        const double side = std::min(width, height) / 2;
        while (side / asked_m > 6.5)
            asked_m *= 2;
        for (const double smaller : {25e3, 10e3, 5e3, 2e3, 1e3}) {
            if (side < asked_m) asked_m = smaller;
        }
    }
    double spacing = round_distance(asked_m, scene.units);
    const double reach = std::hypot(width, height) / 2;
    while (reach / spacing > 20)
        spacing *= 2;
    return spacing;
}

std::vector<GroundPoint> ground_corners(const ViewGeometry& geometry) {
    const double x = geometry.half_x_m();
    const double y = geometry.half_y_m();
    return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

GroundPoint ground_of_site(const MapLines& lines, const grid::SitePosition& site) {
    return GroundMap(*lines.spec).ground({site.latitude_deg, site.longitude_deg});
}

std::vector<Point> ring_points(const MapLines& lines, double radius_m) {
    return ring_of(lines, SiteMap(*lines.spec, lines.sites->front()), radius_m);
}

void clip_to_picture(Canvas& canvas, const MapLines& lines) {
    canvas.clip(picture_outline(lines));
}

void draw_border(Canvas& canvas, const MapLines& lines) {
    clip_to_picture(canvas, lines);
    draw_closed(canvas, ground_outline(lines), lines, 1.2 * lines.scale, lines.shades->border);
    canvas.unclip();
}

void draw_rings(Canvas& canvas, const MapLines& lines) {
    if (lines.sites->size() != 1) return;
    const SiteMap map(*lines.spec, lines.sites->front());
    const GroundPoint site = map.site();
    const double reach = std::hypot(lines.geometry->half_x_m(), lines.geometry->half_y_m()) +
                         std::hypot(site.x_m, site.y_m);
    // If the ground extends past the camera, the visible corners are nearly its outline.
    std::vector<Point> ground;
    for (const Point& p : ground_outline(lines)) {
        if (is_finite(p)) ground.push_back({p.x + lines.left, p.y + lines.top});
    }
    canvas.clip_both(ground, picture_outline(lines));
    for (int i = 1; i * lines.ring_spacing_m < reach && i <= most_rings; ++i) {
        draw_closed(canvas, ring_of(lines, map, i * lines.ring_spacing_m), lines, lines.scale,
                    lines.shades->ring);
    }
    canvas.unclip();
}

}  // namespace stormcellar::render

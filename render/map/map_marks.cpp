#include "render/map/map_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/map/label_places.h"
#include "render/map/map_ground.h"
#include "render/view/length_text.h"

namespace stormcellar::render {
namespace {

constexpr double text_size = 10;
// The look of towns' names. There are three steps, by the size of the town.
struct TownLook {
    int least_population;
    double size;
    bool is_large;
};
constexpr std::array towns = {TownLook{400'000, 10.5, true}, TownLook{100'000, 9.5, true},
                              TownLook{0, 8.5, false}};
// With more sites than this, their names are small and pale.
constexpr std::size_t few_sites = 3;
constexpr double north_radius = 17;
// Limits of the steps in the scale of heights: 1 to 10 km, or 5 to 50 thousand feet.
constexpr double least_step_m = 1000;
constexpr double most_step_m = 15300;

class Planner {
  public:
    Planner(const Fonts& fonts, const MapLines& lines)
        : fonts_(fonts),
          lines_(lines),
          geometry_(*lines.geometry),
          places_(Rect{margin(), margin(), geometry_.width() - 2 * margin(),
                       geometry_.height() - 2 * margin()}) {}

    MapMarks plan() {
        for (const auto& site : *lines_.sites)
            plan_site_mark(site);
        plan_corner();
        if (lines_.glyph_key.x > 0) plan_glyph_key();
        drop_covered_sites();
        for (std::size_t i = 0; i < marks_.sites.size(); ++i)
            plan_site_name(marks_.sites[i], names_[i]);
        marks_.cells = plan_cell_marks(&fonts_, lines_, places_);
        marks_.shapes = plan_shape_marks(&fonts_, lines_, places_);
        if (lines_.heights) plan_heights();
        if (lines_.sites->size() == 1) plan_distances();
        if (lines_.map != nullptr) plan_cities();
        return std::move(marks_);
    }

  private:
    [[nodiscard]] double scaled(double length) const { return length * lines_.scale; }
    [[nodiscard]] double margin() const { return 2 * lines_.scale; }

    [[nodiscard]] std::optional<Point> pixel(GroundPoint p, double height_m) const {
        const Pixel at = geometry_.project(p.x_m, p.y_m, height_m);
        if (!std::isfinite(at.x) || !std::isfinite(at.y)) return std::nullopt;
        return Point{at.x, at.y};
    }
    [[nodiscard]] std::optional<Point> on_ground(GroundPoint p) const {
        return pixel(p, geometry_.ground_m());
    }
    [[nodiscard]] bool inside_grid(GroundPoint p) const {
        return std::isfinite(p.x_m) && std::isfinite(p.y_m) &&
               std::abs(p.x_m) < geometry_.half_x_m() && std::abs(p.y_m) < geometry_.half_y_m();
    }
    // Returns true if the ground at a pixel is that of the grid.
    [[nodiscard]] bool over_grid(Point p) const {
        const auto ground = geometry_.ground({p.x, p.y});
        return ground && inside_grid(*ground);
    }
    static Rect about(Point p, double half) { return {p.x - half, p.y - half, 2 * half, 2 * half}; }

    std::optional<MarkText> claim(const std::string& text, Point left_baseline, double size,
                                  bool bold, Rgba8 color) {
        return claim_text(places_, fonts_, text, left_baseline, {size, bold, color, scaled(1)});
    }

    // Chooses the corner for the arrow and the bar: the first corner without a site, or else the
    // first corner. A site under the arrow or the bar is not drawn.
    void plan_corner() {
        const double w = scaled(2 * north_radius + 8);
        const double h = scaled(2 * north_radius + 28);
        const auto bar = make_scale_bar();
        const double bar_room = bar ? bar->box.width + scaled(5) : 0;
        const double right = geometry_.width() - scaled(11) - w;
        const double bottom = geometry_.height() - scaled(7) - h;
        const double top = scaled(7);
        const std::array<Point, 4> corners = {Point{scaled(11), bottom}, Point{right, bottom},
                                              Point{scaled(11), top}, Point{right, top}};
        const auto whole = [&](Point corner) {
            const double left = corner.x < right ? corner.x : corner.x - bar_room;
            return Rect{left, corner.y, w + bar_room, h};
        };
        const auto free_corner = std::find_if(corners.begin(), corners.end(), [&](Point corner) {
            return places_.is_free(whole(corner));
        });
        const Point corner = free_corner == corners.end() ? corners.front() : *free_corner;
        marks_.north = {corner.x, corner.y, w, h};
        places_.take(marks_.north);
        if (bar) {
            marks_.scale_bar = *bar;
            Rect& box = marks_.scale_bar->box;
            box.x = corner.x < right ? corner.x + w + scaled(5) : corner.x - bar_room;
            box.y = corner.y + h - box.height;
            marks_.scale_bar->left = {std::nearbyint(box.x + scaled(3)),
                                      std::nearbyint(box.bottom() - scaled(5))};
            const bool fits = box.x >= 0 && box.right() <= geometry_.width();
            if (fits) places_.take(box);
            if (!fits) marks_.scale_bar.reset();
        }
    }

    // Puts the key into the first free corner, or else into the first corner without the north
    // arrow.
    void plan_glyph_key() {
        const double w = lines_.glyph_key.x;
        const double h = lines_.glyph_key.y;
        const double right = geometry_.width() - scaled(7) - w;
        const double bottom = geometry_.height() - scaled(7) - h;
        const std::array<Rect, 4> corners = {
            Rect{right, bottom, w, h}, Rect{scaled(7), scaled(7), w, h},
            Rect{right, scaled(7), w, h}, Rect{scaled(7), bottom, w, h}};
        const auto* corner =
            std::ranges::find_if(corners, [&](const Rect& box) { return places_.is_free(box); });
        if (corner == corners.end()) {
            corner = std::ranges::find_if(
                corners, [&](const Rect& box) { return !overlaps(box, marks_.north); });
        }
        if (corner == corners.end()) return;
        marks_.glyph_key = *corner;
        places_.take(*corner);
    }

    void drop_covered_sites() {
        for (std::size_t i = marks_.sites.size(); i-- > 0;) {
            const Rect mark = about(marks_.sites[i], scaled(4));
            const bool covered = overlaps(mark, marks_.north) ||
                                 (marks_.scale_bar && overlaps(mark, marks_.scale_bar->box)) ||
                                 (marks_.glyph_key && overlaps(mark, *marks_.glyph_key));
            if (!covered) continue;
            marks_.sites.erase(marks_.sites.begin() + static_cast<std::ptrdiff_t>(i));
            names_.erase(names_.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
    static bool overlaps(const Rect& a, const Rect& b) {
        return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
    }

    // Returns how many meters on WGS84 a pixel covers, across the middle of the picture.
    [[nodiscard]] std::optional<double> metres_per_pixel() const {
        const double x = 0.5 * geometry_.width();
        const double y = 0.5 * geometry_.height();
        const double reach = 0.05 * geometry_.width();
        const auto left = geometry_.ground({x - reach, y});
        const auto right = geometry_.ground({x + reach, y});
        if (!left || !right) return std::nullopt;
        const GroundMap map(*lines_.spec);
        const grid::GeoPoint from = map.place(*left);
        const double apart_m = grid::SiteFrame(from.latitude_deg, from.longitude_deg)
                                   .to_polar(map.place(*right))
                                   .arc_m;
        if (!std::isfinite(apart_m) || apart_m <= 0) return std::nullopt;
        return apart_m / (2 * reach);
    }

    // Makes the scale bar. Its place is set later.
    [[nodiscard]] std::optional<ScaleBar> make_scale_bar() const {
        const auto metres = metres_per_pixel();
        if (!metres) return std::nullopt;
        const double most_m = *metres * std::min(0.25 * geometry_.width(), scaled(130));
        const double unit_m = facts_of(lines_.units.distance).si;
        const double power = unit_m * std::pow(10, std::floor(std::log10(most_m / unit_m)));
        ScaleBar bar;
        for (const double digit : {1.0, 2.0, 5.0}) {
            if (digit * power <= most_m) bar.metres = digit * power;
        }
        bar.length = bar.metres / *metres;
        const double size = scaled(text_size);
        const double width = std::max(
            bar.length,
            scaled(3) + fonts_.width(distance_text(bar.metres, lines_.units), size, false));
        bar.box = {0, 0, width + scaled(6), size + scaled(11)};
        return bar;
    }

    void plan_site_mark(const grid::SitePosition& site) {
        const GroundPoint p = ground_of_site(lines_, site);
        if (!inside_grid(p)) return;
        const auto at = on_ground(p);
        const double r = scaled(4);
        if (!at || at->x < r || at->y < r || at->x > geometry_.width() - r ||
            at->y > geometry_.height() - r) {
            return;
        }
        marks_.sites.push_back(*at);
        names_.push_back(site.icao);
        places_.take(about(*at, r));
    }

    void plan_site_name(Point at, const std::string& name) {
        const bool few = marks_.sites.size() <= few_sites;
        const double size = scaled(few ? text_size : 8.5);
        const double width = fonts_.width(name, size, few);
        const double right = at.x + scaled(6);
        const double left = at.x - scaled(6) - width;
        const double above = at.y - scaled(3);
        const double below = at.y + 0.8 * size + scaled(2);
        for (const Point& corner :
             {Point{right, above}, Point{left, above}, Point{right, below}, Point{left, below}}) {
            if (auto text = claim(name, corner, size, few,
                                  few ? lines_.shades->text : lines_.shades->quiet_text)) {
                marks_.site_texts.push_back(std::move(*text));
                return;
            }
        }
    }

    // Places the scale of heights at the leftmost upright edge of the box in the picture. If two
    // edges are equally far left, takes the farther edge, which is higher in the picture. The edge
    // is an outline of the box, so no echo is ever behind it.
    void plan_heights() {
        std::optional<GroundPoint> edge;
        Point edge_at;
        for (const GroundPoint& corner : ground_corners(geometry_)) {
            const auto at = on_ground(corner);
            if (!at) return;
            const bool better =
                !edge || at->x < edge_at.x - 0.5 || (at->x < edge_at.x + 0.5 && at->y < edge_at.y);
            if (!better) continue;
            edge = corner;
            edge_at = *at;
        }
        const double top_m = geometry_.top_m();
        const auto top = pixel(*edge, top_m);
        const auto zero = pixel(*edge, 0);
        const double unit_m = height_step_unit_m(lines_.units);
        const auto one_unit = pixel(*edge, unit_m);
        if (!top || !zero || !one_unit) return;
        const double size = scaled(text_size);
        const double unit = std::abs(one_unit->y - zero->y);
        double step_m = 0;
        for (const double steps : {50.0, 20.0, 10.0, 5.0, 2.0, 1.0}) {
            const bool is_usual = steps * unit_m >= least_step_m && steps * unit_m <= most_step_m;
            if (is_usual && unit * steps >= 1.7 * size) step_m = steps * unit_m;
        }
        if (step_m == 0) return;
        const double width = fonts_.width(height_text(10 * unit_m, lines_.units), size, false);
        HeightScale heights{edge_at, *top, {}, edge_at.x > width + scaled(12) ? -1.0 : 1.0};
        for (int i = 1; i * step_m <= top_m; ++i) {
            const auto tick = pixel(*edge, i * step_m);
            if (!tick || tick->y < size || tick->y > geometry_.height() - size) continue;
            const std::string text = height_text(i * step_m, lines_.units);
            const double x = tick->x + heights.side * scaled(7) -
                             (heights.side < 0 ? fonts_.width(text, size, false) : 0);
            auto placed =
                claim(text, {x, tick->y + 0.36 * size}, size, false, lines_.shades->quiet_text);
            if (!placed) continue;
            heights.ticks.push_back(*tick);
            marks_.height_texts.push_back(std::move(*placed));
        }
        marks_.heights = std::move(heights);
    }

    // Writes the distances on the rings, at the place where each ring is nearest to the viewer.
    // This is the lowest place in the picture.
    void plan_distances() {
        const double size = scaled(text_size);
        for (int i = 1; i <= 40; ++i) {
            const auto ring = ring_points(lines_, i * lines_.ring_spacing_m);
            const Point* lowest = nullptr;
            for (const Point& p : ring) {
                if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
                if (lowest == nullptr || p.y > lowest->y + 1e-6) lowest = &p;
            }
            if (lowest == nullptr) return;
            const auto ground = geometry_.ground({lowest->x, lowest->y});
            if (!ground || !inside_grid(*ground)) return;
            const std::string text = distance_text(i * lines_.ring_spacing_m, lines_.units);
            const double width = fonts_.width(text, size, false);
            if (auto placed = claim(text, {lowest->x - width / 2, lowest->y + 0.36 * size}, size,
                                    false, lines_.shades->quiet_text)) {
                marks_.ground_texts.push_back(std::move(*placed));
            }
        }
    }

    void plan_cities() {
        const double dot = scaled(2.6);
        const double apart = scaled(38);
        for (const MapPlace& city : lines_.map->cities) {
            // Keep a distance between cities, so that the map stays quiet.
            const bool crowded =
                std::any_of(marks_.cities.begin(), marks_.cities.end(), [&](const Point& other) {
                    return std::hypot(other.x - city.at.x, other.y - city.at.y) < apart;
                });
            if (crowded || !places_.is_free(about(city.at, dot))) continue;
            const TownLook& look = *std::ranges::find_if(towns, [&](const TownLook& town) {
                return city.population >= town.least_population;
            });
            const double size = scaled(look.size);
            const Rgba8 color = look.is_large ? lines_.shades->city : lines_.shades->small_city;
            const double width = fonts_.width(city.name, size, false);
            const double right = city.at.x + scaled(4.5);
            const double left = city.at.x - scaled(4.5) - width;
            const double level = city.at.y + 0.36 * size;
            const double middle = city.at.x - width / 2;
            std::vector<Point> corners = {Point{right, level}, Point{left, level},
                                          Point{middle, city.at.y - scaled(3.5) - 0.3 * size},
                                          Point{middle, city.at.y + 0.8 * size + scaled(5)}};
            // Try last the corners where a name would cross the edge of the grid, because the edge
            // seems to cut the name.
            std::stable_partition(corners.begin(), corners.end(), [&](const Point& corner) {
                return over_grid(corner) && over_grid({corner.x + width, corner.y});
            });
            for (const Point& corner : corners) {
                auto text = claim(city.name, corner, size, false, color);
                if (!text) continue;
                marks_.ground_texts.push_back(std::move(*text));
                marks_.cities.push_back(city.at);
                places_.take(about(city.at, dot));
                break;
            }
        }
    }

    const Fonts& fonts_;
    const MapLines& lines_;
    const ViewGeometry& geometry_;
    LabelPlaces places_;
    MapMarks marks_;
    std::vector<std::string> names_;
};

}  // namespace

MapMarks plan_marks(const Fonts& fonts, const MapLines& lines) {
    return Planner(fonts, lines).plan();
}

}  // namespace stormcellar::render

#include "render/map/map_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "render/image/area_mask.h"
#include "render/map/map_ground.h"
#include "render/products/ground.h"

namespace stormcellar::render {
namespace {

constexpr double earth_radius_m = 6371e3;
constexpr double most_thinned_px = 0.7;
constexpr double most_bent_px = 0.2;
constexpr double least_step_px = 0.3;
// Cairo cannot represent numbers beyond this. A point that is so far away is not visible.
constexpr double farthest_px = 1e6;
constexpr double most_mask_cells = 4096;  // along a side
constexpr double most_tile_edge_deg = 0.25;

struct Box {
    double west = 0, south = 0, east = 0, north = 0;
};

// Returns the part of the ground that the picture shows: the grid, and what is within
// reach_beyond_m() of it.
Box visible_ground(const ViewGeometry& geometry) {
    const double reach = reach_beyond_m(geometry);
    const Box grid = {-geometry.half_x_m() - reach, -geometry.half_y_m() - reach,
                      geometry.half_x_m() + reach, geometry.half_y_m() + reach};
    Box seen = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    const double w = geometry.width();
    const double h = geometry.height();
    for (const Pixel corner : {Pixel{0, 0}, Pixel{w, 0}, Pixel{w, h}, Pixel{0, h}}) {
        const auto ground = geometry.ground(corner);
        if (!ground || !std::isfinite(ground->x_m) || !std::isfinite(ground->y_m)) return grid;
        seen.west = std::min(seen.west, ground->x_m);
        seen.south = std::min(seen.south, ground->y_m);
        seen.east = std::max(seen.east, ground->x_m);
        seen.north = std::max(seen.north, ground->y_m);
    }
    return {std::max(grid.west, seen.west), std::max(grid.south, seen.south),
            std::min(grid.east, seen.east), std::min(grid.north, seen.north)};
}

// Returns how many meters of ground a pixel covers in the finest part of the picture.
double finest_metres_per_pixel(const ViewGeometry& geometry) {
    double finest = HUGE_VAL;
    for (const double share : {0.5, 0.75, 1.0}) {
        const double y = share * geometry.height();
        const double x = 0.5 * geometry.width();
        const auto left = geometry.ground({x - 1, y});
        const auto right = geometry.ground({x + 1, y});
        if (!left || !right) continue;
        const double apart = std::hypot(right->x_m - left->x_m, right->y_m - left->y_m) / 2;
        if (std::isfinite(apart)) finest = std::min(finest, apart);
    }
    return std::isfinite(finest) && finest > 0 ? finest : geometry.metres_per_pixel();
}

// Returns the range of latitudes and longitudes of a part of the ground, with a margin. Longitudes
// are continuous, so they may leave -180..180.
Box degrees_of(const GroundMap& ground, const Box& box) {
    constexpr int steps = 32;
    Box found = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const bool at_edge = i == 0 || i == steps || j == 0 || j == steps;
            if (!at_edge && (i % 8 != 0 || j % 8 != 0)) continue;
            const grid::GeoPoint place =
                ground.place({box.west + (box.east - box.west) * i / steps,
                              box.south + (box.north - box.south) * j / steps});
            const double longitude =
                ground.projection().continuous_longitude_deg(place.longitude_deg);
            found.west = std::min(found.west, longitude);
            found.east = std::max(found.east, longitude);
            found.south = std::min(found.south, place.latitude_deg);
            found.north = std::max(found.north, place.latitude_deg);
        }
    }
    const double room = 0.05 + 0.02 * (found.north - found.south);
    found = {found.west - 2 * room, found.south - room, found.east + 2 * room, found.north + room};
    // Near a pole all longitudes may be inside.
    if (found.north > 88 || found.south < -88) {
        found.west = -1000;
        found.east = 1000;
    }
    return found;
}

bool touches(const MapLine& line, const Box& degrees) {
    if (line.south_deg > degrees.north || line.north_deg < degrees.south) return false;
    for (const double turn : {-360.0, 0.0, 360.0}) {
        if (line.west_deg + turn <= degrees.east && line.east_deg + turn >= degrees.west) {
            return true;
        }
    }
    return false;
}

// Clips a segment to a box (Liang and Barsky 1984). Returns false if nothing is left.
bool clip(GroundPoint& a, GroundPoint& b, const Box& box) {
    double from = 0;
    double to = 1;
    const double dx = b.x_m - a.x_m;
    const double dy = b.y_m - a.y_m;
    const std::array<double, 4> steps = {-dx, dx, -dy, dy};
    const std::array<double, 4> rooms = {a.x_m - box.west, box.east - a.x_m, a.y_m - box.south,
                                         box.north - a.y_m};
    for (std::size_t i = 0; i < 4; ++i) {
        if (steps[i] == 0) {
            if (rooms[i] < 0) return false;
        } else if (steps[i] < 0) {
            from = std::max(from, rooms[i] / steps[i]);
        } else {
            to = std::min(to, rooms[i] / steps[i]);
        }
    }
    if (from > to) return false;
    b = {a.x_m + to * dx, a.y_m + to * dy};
    a = {a.x_m + from * dx, a.y_m + from * dy};
    return true;
}

// Makes strokes from lines, one after the other.
class Tracer {
  public:
    Tracer(const GroundMap& ground, const ViewGeometry& geometry, const Box& box, double finest_m,
           std::vector<MapStroke>& strokes)
        : ground_(ground),
          geometry_(geometry),
          box_(box),
          most_bent_m_(most_bent_px * finest_m),
          strokes_(strokes) {}

    // Traces one line. `at` has the place of each point on the ground.
    void trace(MapKind kind, const std::vector<grid::GeoPoint>& line,
               const std::vector<GroundPoint>& at) {
        kind_ = kind;
        break_off();
        Vertex last{line.front(), at.front()};
        for (std::size_t i = 1; i < line.size(); ++i) {
            const Vertex next{line[i], at[i]};
            if (is_area(kind) && is_tile_edge(last.place, next.place)) {
                break_off();
            } else {
                divide(last, next, 0);
            }
            last = next;
        }
        break_off();
    }

  private:
    struct Vertex {
        grid::GeoPoint place;
        GroundPoint at;
    };

    void divide(const Vertex& a, const Vertex& b, int depth) {
        if (!is_finite(a.at) || !is_finite(b.at)) return break_off();
        const double length = std::hypot(b.at.x_m - a.at.x_m, b.at.y_m - a.at.y_m);
        // The bound is four times the sagitta of a parallel at 45 degrees of latitude. This is
        // enough up to latitude 75.
        const bool may_bend = length * length / (2 * earth_radius_m) > most_bent_m_;
        if (!may_bend || depth == 12) return segment(a.at, b.at);
        Vertex middle;
        middle.place = {(a.place.latitude_deg + b.place.latitude_deg) / 2,
                        (a.place.longitude_deg + b.place.longitude_deg) / 2};
        middle.at = ground_.ground(middle.place);
        const double off = std::hypot(middle.at.x_m - (a.at.x_m + b.at.x_m) / 2,
                                      middle.at.y_m - (a.at.y_m + b.at.y_m) / 2);
        if (off <= most_bent_m_) {
            segment(a.at, middle.at);
            return segment(middle.at, b.at);
        }
        divide(a, middle, depth + 1);
        divide(middle, b, depth + 1);
    }

    void segment(GroundPoint a, GroundPoint b) {
        const GroundPoint end = b;
        if (!is_finite(a) || !is_finite(b) || !clip(a, b, box_)) return break_off();
        const Point from = pixel(a);
        const Point to = pixel(b);
        if (!is_visible(from) || !is_visible(to)) return break_off();
        if (points_.empty()) points_.push_back(from);
        waiting_ = to;
        has_waiting_ = true;
        if (std::hypot(to.x - points_.back().x, to.y - points_.back().y) >= least_step_px) {
            points_.push_back(to);
            has_waiting_ = false;
        }
        // The far end of the segment was cut off, so the next segment does not begin there.
        if (b.x_m != end.x_m || b.y_m != end.y_m) break_off();
    }

    void break_off() {
        if (has_waiting_ && !points_.empty()) points_.push_back(waiting_);
        has_waiting_ = false;
        if (points_.size() >= 2) strokes_.push_back({kind_, points_});
        points_.clear();
    }

    [[nodiscard]] Point pixel(GroundPoint p) const {
        const Pixel at = geometry_.project(p.x_m, p.y_m, geometry_.ground_m());
        return {at.x, at.y};
    }
    static bool is_finite(GroundPoint p) { return std::isfinite(p.x_m) && std::isfinite(p.y_m); }
    static bool is_visible(Point p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::abs(p.x) < farthest_px &&
               std::abs(p.y) < farthest_px;
    }

    const GroundMap& ground_;
    const ViewGeometry& geometry_;
    Box box_;
    double most_bent_m_;
    std::vector<MapStroke>& strokes_;
    MapKind kind_ = MapKind::coast;
    std::vector<Point> points_;
    Point waiting_;
    bool has_waiting_ = false;
};

// Returns the set of this kind to draw: the coarsest that is fine enough, else the finest.
const MapSet* best_set(const BaseMap& map, MapKind kind, double most_thinned_m) {
    const MapSet* best = nullptr;
    for (const MapSet& set : map.sets()) {
        if (set.kind != kind) continue;
        const bool fits = set.tolerance_m <= most_thinned_m;
        if (best == nullptr || (fits && set.tolerance_m > best->tolerance_m) ||
            (best->tolerance_m > most_thinned_m && set.tolerance_m < best->tolerance_m)) {
            best = &set;
        }
    }
    return best;
}

// Returns the part of the ground whose cities are shown. If the view is not from straight above,
// this is only the grid, because the ground beyond it fades.
Box box_of_cities(const ViewGeometry& geometry, const Box& shown) {
    if (is_from_above(geometry)) return shown;
    return {std::max(shown.west, -geometry.half_x_m()), std::max(shown.south, -geometry.half_y_m()),
            std::min(shown.east, geometry.half_x_m()), std::min(shown.north, geometry.half_y_m())};
}

void add_cities(const BaseMap& map, const GroundMap& ground, const ViewGeometry& geometry,
                const Box& box, const Box& degrees, MapLayer& layer) {
    for (const MapCity& city : map.cities()) {
        const MapLine spot = {city.place.longitude_deg,
                              city.place.latitude_deg,
                              city.place.longitude_deg,
                              city.place.latitude_deg,
                              0,
                              {}};
        if (!touches(spot, degrees)) continue;
        const GroundPoint at = ground.ground(city.place);
        const bool inside =
            at.x_m >= box.west && at.x_m <= box.east && at.y_m >= box.south && at.y_m <= box.north;
        if (!inside) continue;
        const Pixel pixel = geometry.project(at.x_m, at.y_m, geometry.ground_m());
        if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) continue;
        if (pixel.x >= 0 && pixel.y >= 0 && pixel.x <= geometry.width() &&
            pixel.y <= geometry.height()) {
            layer.cities.push_back({{pixel.x, pixel.y}, city.name, city.population});
        }
    }
}

// Draws the rings of areas into a raster of the ground.
class WaterPainter {
  public:
    WaterPainter(const GroundMap& ground, const Box& box, double finest_m)
        : ground_(ground), mask_(mask_over(box, finest_m)), area_(mask_.width, mask_.height) {}

    // Returns the points of a ring, counted in cells. Its segments are straight in degrees. `at`
    // has the place of each point on the ground. The edges of tiles are long, so they are divided;
    // the points are the same for both neighboring tiles. Any thread may call this.
    [[nodiscard]] std::vector<Point> cells_of(const std::vector<grid::GeoPoint>& ring,
                                              const std::vector<GroundPoint>& at) const {
        std::vector<Point> cells;
        for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
            put(at[i], cells);
            if (!is_tile_edge(ring[i], ring[i + 1])) continue;
            const bool upright = std::abs(ring[i].longitude_deg - ring[i + 1].longitude_deg) < 1e-7;
            const auto along = [&](const grid::GeoPoint& p) {
                return (upright ? p.latitude_deg : p.longitude_deg) / most_tile_edge_deg;
            };
            const double from = along(ring[i]);
            const double to = along(ring[i + 1]);
            const double step = to > from ? 1 : -1;
            for (double part = step > 0 ? std::floor(from) + 1 : std::ceil(from) - 1;
                 step * part < step * to; part += step) {
                grid::GeoPoint between = ring[i];
                (upright ? between.latitude_deg : between.longitude_deg) =
                    part * most_tile_edge_deg;
                put(ground_.ground(between), cells);
            }
        }
        return cells;
    }

    void add(MapKind kind, std::vector<Point> cells) {
        if (cells.size() < 3) return;
        if (kind == MapKind::lake) {
            lakes_.push_back(std::move(cells));
        } else {
            area_.add(cells);
        }
    }

    WaterMask finish() {
        area_.put(true);
        for (const std::vector<Point>& lake : lakes_)
            area_.add(lake);
        area_.put(false);
        mask_.water = area_.cells();
        for (std::uint8_t& cell : mask_.water)
            cell = static_cast<std::uint8_t>(255 - cell);
        return std::move(mask_);
    }

  private:
    static WaterMask mask_over(const Box& box, double finest_m) {
        const double side = std::max(box.east - box.west, box.north - box.south);
        WaterMask mask;
        mask.metres_per_cell = std::max(finest_m, side / most_mask_cells);
        mask.west_m = box.west;
        mask.north_m = box.north;
        mask.width = static_cast<int>(std::ceil((box.east - box.west) / mask.metres_per_cell));
        mask.height = static_cast<int>(std::ceil((box.north - box.south) / mask.metres_per_cell));
        mask.width = std::max(1, mask.width);
        mask.height = std::max(1, mask.height);
        return mask;
    }
    void put(GroundPoint at, std::vector<Point>& cells) const {
        if (!std::isfinite(at.x_m) || !std::isfinite(at.y_m)) return;
        const Point cell = {(at.x_m - mask_.west_m) / mask_.metres_per_cell,
                            (mask_.north_m - at.y_m) / mask_.metres_per_cell};
        cells.push_back({std::clamp(cell.x, -farthest_px, farthest_px),
                         std::clamp(cell.y, -farthest_px, farthest_px)});
    }

    const GroundMap& ground_;
    WaterMask mask_;
    AreaMask area_;
    std::vector<std::vector<Point>> lakes_;
};

struct ShownLine {
    MapKind kind;
    const MapLine* line;
};

// Returns the lines in the order in which the kinds are drawn.
std::vector<ShownLine> shown_lines(const BaseMap& map, const Box& degrees, double finest_m,
                                   double scale) {
    std::vector<ShownLine> shown;
    for (const auto& [kind, name, usual_m, least_px] : map_kinds) {
        if (usual_m / finest_m < least_px * scale) continue;
        const MapSet* set = best_set(map, kind, most_thinned_px * finest_m);
        if (set == nullptr) continue;
        for (const MapLine& line : set->lines) {
            if (touches(line, degrees)) shown.push_back({kind, &line});
        }
    }
    return shown;
}

struct TracedLine {
    std::vector<MapStroke> strokes;
    std::vector<Point> cells;  // the ring of an area, in cells of the raster
    std::optional<Error> error;
};

struct Look {
    double width;
    Rgba8 color;
};

Look look_of(MapKind kind, const Shades& shades) {
    switch (kind) {
        case MapKind::county:
            return {0.6, shades.county};
        case MapKind::state:
            return {0.9, shades.state};
        case MapKind::lake:
            return {0.8, shades.coast};
        case MapKind::country:
            return {1.2, shades.country};
        case MapKind::interstate:
            return {1.0, shades.interstate};
        case MapKind::highway:
            return {0.6, shades.highway};
        case MapKind::coast:
            break;
    }
    return {1.0, shades.coast};
}

}  // namespace

Result<MapLayer> prepare_map(const BaseMap& map, const grid::GridSpec& spec,
                             const ViewGeometry& geometry, double scale, int threads) {
    MapLayer layer;
    const Box box = visible_ground(geometry);
    if (!(box.west < box.east && box.south < box.north)) return layer;
    const GroundMap ground(spec);
    const Box degrees = degrees_of(ground, box);
    const double finest_m = finest_metres_per_pixel(geometry);
    WaterPainter painter(ground, box, finest_m);
    const auto lines = shown_lines(map, degrees, finest_m, scale);
    std::vector<TracedLine> traced(lines.size());
    for_each_piece(static_cast<int>(lines.size()), threads, [&](int i) {
        const auto& [kind, line] = lines[static_cast<std::size_t>(i)];
        TracedLine& result = traced[static_cast<std::size_t>(i)];
        const auto points = map.points_of(*line);
        if (!points) {
            result.error = points.error();
            return;
        }
        std::vector<GroundPoint> at;
        at.reserve(points->size());
        for (const grid::GeoPoint& place : *points)
            at.push_back(ground.ground(place));
        Tracer(ground, geometry, box, finest_m, result.strokes).trace(kind, *points, at);
        if (is_area(kind)) result.cells = painter.cells_of(*points, at);
    });
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (traced[i].error) return tl::unexpected(*traced[i].error);
        std::ranges::move(traced[i].strokes, std::back_inserter(layer.strokes));
        if (is_area(lines[i].kind)) painter.add(lines[i].kind, std::move(traced[i].cells));
    }
    layer.water = painter.finish();
    add_cities(map, ground, geometry, box_of_cities(geometry, box), degrees, layer);
    return layer;
}

Result<const MapLayer*> MapCache::get(const grid::GridSpec& spec, const ViewGeometry& geometry,
                                      double scale, int threads) {
    // The view of a plane is determined by the views of four of its points, no three of them on a
    // line.
    std::vector<double> view = {static_cast<double>(geometry.width()),
                                static_cast<double>(geometry.height()), scale};
    const double h = geometry.ground_m();
    for (const double x : {-geometry.half_x_m(), geometry.half_x_m()}) {
        for (const double y : {-geometry.half_y_m(), geometry.half_y_m()}) {
            const Pixel at = geometry.project(x, y, h);
            view.push_back(at.x);
            view.push_back(at.y);
        }
    }
    const bool is_known =
        std::all_of(view.begin(), view.end(), [](double v) { return std::isfinite(v); });
    if (times_made_ > 0 && is_known && view == view_ && spec == spec_) return &layer_;
    static const Result<BaseMap> map = BaseMap::built_in();
    if (!map) return pass_on(map);
    auto layer = prepare_map(*map, spec, geometry, scale, threads);
    if (!layer) return pass_on(layer);
    layer_ = std::move(*layer);
    spec_ = spec;
    view_ = std::move(view);
    ++times_made_;
    return &layer_;
}

void draw_map(Canvas& canvas, const MapLayer& layer, const Shades& shades, double scale,
              Point offset) {
    for (const bool casing : {true, false}) {
        for (auto first = layer.strokes.begin(); first != layer.strokes.end();) {
            const auto last = std::find_if(first, layer.strokes.end(), [&](const MapStroke& s) {
                return s.kind != first->kind;
            });
            Look look = look_of(first->kind, shades);
            if (casing) look = {look.width + 1.6, shades.casing};
            for (; first != last; ++first)
                canvas.add_to_path(first->points, offset);
            canvas.draw_path(look.width * scale, look.color);
        }
    }
}

}  // namespace stormcellar::render

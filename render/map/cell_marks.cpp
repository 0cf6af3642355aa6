#include "render/map/cell_marks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/degree.h"
#include "render/map/map_ground.h"
#include "retrieve/cells/track_motion.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::render {
namespace {

using retrieve::CellForecast;
using retrieve::TrackedCell;

// Lengths at scale 1, in pixels.
constexpr double ring_radius = 5;
constexpr double ring_width = 1.6;
constexpr double track_width = 1.5;
constexpr double error_width = 0.8;
constexpr double tick_half = 3.2;
constexpr double dash = 5;
constexpr double gap = 3.5;
constexpr double most_dashed = 20'000;  // in pixels at any scale
constexpr double halo_room = 1;
constexpr double label_size = 10;
constexpr float least_hail_mm = 5;  // smaller ice is no hail (WMO, International Cloud Atlas)
constexpr std::array error_minutes = {30, 60};
constexpr int error_corners = 48;

bool is_finite_point(Point p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

Point toward(Point from, Point unit, double length) {
    return {from.x + unit.x * length, from.y + unit.y * length};
}

// Returns the unit vector from one point to another; zero if they are the same.
Point unit_between(Point from, Point to) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (!(length > 0)) return {};
    return {(to.x - from.x) / length, (to.y - from.y) / length};
}

class CellPlanner {
  public:
    CellPlanner(const MapLines& lines, LabelPlaces& places)
        : lines_(lines),
          scan_(lines.cells->scan),
          places_(places),
          ground_(*lines.spec),
          seconds_late_(std::max(0.0, seconds_between(scan_.time, lines.time))) {}

    std::vector<CellMark> plan(const Fonts* fonts) {
        std::vector<CellMark> marks;
        std::vector<const TrackedCell*> marked;
        for (const TrackedCell& cell : scan_.cells) {
            auto mark = mark_of(cell);
            if (!mark) continue;
            const double r = scaled(ring_radius + halo_room);
            places_.take({mark->center.x - r, mark->center.y - r, 2 * r, 2 * r});
            marks.push_back(std::move(*mark));
            marked.push_back(&cell);
        }
        for (std::size_t i = 0; fonts != nullptr && i < marks.size(); ++i)
            plan_label(*fonts, marked[i]->cell, marks[i]);
        return marks;
    }

  private:
    [[nodiscard]] double scaled(double length) const { return length * lines_.scale; }

    [[nodiscard]] Point pixel(grid::GeoPoint place, double height_m) const {
        const GroundPoint at = ground_.ground(place);
        const Pixel found = lines_.geometry->project(at.x_m, at.y_m, height_m);
        return {found.x, found.y};
    }
    [[nodiscard]] Point on_ground(grid::GeoPoint place) const {
        return pixel(place, lines_.geometry->ground_m());
    }
    [[nodiscard]] bool is_in_picture(Point p) const {
        return is_finite_point(p) && p.x >= 0 && p.y >= 0 && p.x <= lines_.geometry->width() &&
               p.y <= lines_.geometry->height();
    }

    // Returns none for a cell that the camera does not see. Its lines may still cross the picture.
    [[nodiscard]] std::optional<CellMark> mark_of(const TrackedCell& cell) const {
        const bool is_moved = cell.motion && seconds_late_ > 0;
        const grid::GeoPoint place =
            is_moved
                ? retrieve::moved_place(cell.cell.position, cell.motion->velocity, seconds_late_)
                : cell.cell.position;
        CellMark mark;
        mark.center = on_ground(place);
        if (!is_finite_point(mark.center)) return std::nullopt;
        if (lines_.heights) {
            const Point top = pixel(place, cell.cell.max_dbz_height_m);
            if (is_finite_point(top)) mark.top = top;
        }
        std::vector<grid::GeoPoint> behind;
        if (is_moved) behind.push_back(cell.cell.position);
        for (auto past = cell.past.rbegin(); past != cell.past.rend(); ++past)
            behind.push_back(past->position);
        mark.track = line_through(mark.center, behind);
        plan_forecasts(cell, mark);
        return mark;
    }

    // Returns the line from a point through places; it ends before a place that is not seen.
    [[nodiscard]] std::vector<Point> line_through(Point from,
                                                  const std::vector<grid::GeoPoint>& places) const {
        std::vector<Point> line = {from};
        for (const grid::GeoPoint& place : places) {
            const Point p = on_ground(place);
            if (!is_finite_point(p)) break;
            line.push_back(p);
        }
        return line;
    }

    void plan_forecasts(const TrackedCell& cell, CellMark& mark) const {
        std::vector<grid::GeoPoint> places;
        std::vector<const CellForecast*> coming;
        for (const CellForecast& forecast : cell.forecasts) {
            if (60.0 * forecast.minutes <= seconds_late_) continue;
            places.push_back(forecast.position);
            coming.push_back(&forecast);
        }
        mark.ahead = line_through(mark.center, places);
        for (std::size_t i = 1; i < mark.ahead.size(); ++i) {
            const Point along = unit_between(mark.ahead[i - 1], mark.ahead[i]);
            const Point across = {-along.y, along.x};
            const double half = scaled(tick_half);
            if (std::hypot(along.x, along.y) > 0) {
                mark.ticks.push_back(
                    {toward(mark.ahead[i], across, -half), toward(mark.ahead[i], across, half)});
            }
            const CellForecast& forecast = *coming[i - 1];
            if (std::ranges::find(error_minutes, forecast.minutes) == error_minutes.end()) continue;
            auto circle = circle_about(forecast.position, forecast.error_m);
            if (!circle.empty()) mark.errors.push_back(std::move(circle));
        }
    }

    // Returns a circle on the ground; empty if the camera does not see all of it.
    [[nodiscard]] std::vector<Point> circle_about(grid::GeoPoint middle, double radius_m) const {
        const grid::SiteFrame frame(middle.latitude_deg, middle.longitude_deg);
        std::vector<Point> circle;
        for (int i = 0; i < error_corners; ++i) {
            circle.push_back(on_ground(frame.to_geo({i * (360.0 / error_corners), radius_m})));
            if (!is_finite_point(circle.back())) return {};
        }
        return circle;
    }

    void plan_label(const Fonts& fonts, const retrieve::StormCell& cell, CellMark& mark) {
        const Point at = mark.top.value_or(mark.center);
        if (!is_in_picture(at)) return;
        const std::string least = fmt::format("{:.0f}", cell.max_dbz);
        std::string whole = least + " dBZ";
        if (cell.mesh_mm.value_or(0) >= least_hail_mm)
            whole += fmt::format(", {:.0f} mm", *cell.mesh_mm);
        const MarkTextLook look{scaled(label_size), true, lines_.shades->text, scaled(1)};
        for (const std::string& text : {whole, least}) {
            const double width = fonts.width(text, look.size, look.bold);
            for (const Point& corner : corners_for(width, look.size, mark)) {
                mark.label = claim_text(places_, fonts, text, corner, look);
                if (mark.label) return;
            }
        }
    }

    // Returns places of a label beside a mark: first those beside the line of motion.
    [[nodiscard]] std::vector<Point> corners_for(double width, double size,
                                                 const CellMark& mark) const {
        // A label beside a short stem stays clear of the ring at the stem's foot.
        const bool has_stem = mark.top && std::hypot(mark.top->x - mark.center.x,
                                                     mark.top->y - mark.center.y) > 3 * size;
        const Point at = has_stem ? *mark.top : mark.center;
        const double apart = scaled(has_stem ? 4 : ring_radius + 3);
        const std::vector<Point>& line = mark.ahead.size() > 1 ? mark.ahead : mark.track;
        const Point along = unit_between(line.front(), line.back());
        std::vector<Point> sides = {{1, 0},  {-1, 0},  {0, -1}, {0, 1},
                                    {1, -1}, {-1, -1}, {1, 1},  {-1, 1}};
        // Rounded, so that small changes of the motion do not move labels from frame to frame.
        std::ranges::stable_sort(sides, {}, [&](Point side) {
            return std::round(2 * std::abs(side.x * along.x + side.y * along.y) /
                              std::hypot(side.x, side.y));
        });
        for (Point& side : sides) {
            const double share = side.x != 0 && side.y != 0 ? 0.8 : 1;
            const double x = at.x + side.x * share * apart;
            const double before = side.x > 0 ? 0 : side.x < 0 ? width : width / 2;
            const double below = side.y > 0 ? 0.85 * size : side.y < 0 ? -0.35 * size : 0.36 * size;
            side = {x - before, at.y + side.y * share * apart + below};
        }
        return sides;
    }

    const MapLines& lines_;
    const retrieve::TrackedScan& scan_;
    LabelPlaces& places_;
    GroundMap ground_;
    double seconds_late_;  // from the volume to the picture
};

double length_of_line(const std::vector<Point>& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
        sum += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    return sum;
}

// Returns the part of a line between two distances from its first point.
std::vector<Point> part_of_line(const std::vector<Point>& line, double from, double to) {
    std::vector<Point> part;
    double before = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double length = std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
        const Point unit = unit_between(line[i - 1], line[i]);
        const double first = std::max(from - before, 0.0);
        const double last = std::min(to - before, length);
        before += length;
        if (!(first < last)) continue;
        if (part.empty()) part.push_back(toward(line[i - 1], unit, first));
        part.push_back(toward(line[i - 1], unit, last));
    }
    return part;
}

// Adds the dashes of a line to the canvas's path. A line that is longer than any picture is cut.
void add_dashes(Canvas& canvas, const std::vector<Point>& line, double scale, Point offset) {
    const double length = std::min(length_of_line(line), most_dashed);
    const double period = (dash + gap) * scale;
    for (int i = 0; i * period < length; ++i) {
        const double end = std::min(i * period + dash * scale, length);
        canvas.add_to_path(part_of_line(line, i * period, end), offset);
    }
}

std::vector<Point> closed(std::vector<Point> line) {
    line.push_back(line.front());
    return line;
}

std::vector<Point> ring_about(Point center, double radius) {
    std::vector<Point> ring;
    for (int i = 0; i <= 32; ++i) {
        const double turn = i * 11.25 * degree;
        ring.push_back(toward(center, {std::cos(turn), std::sin(turn)}, radius));
    }
    return ring;
}

}  // namespace

std::vector<CellMark> plan_cell_marks(const Fonts* fonts, const MapLines& lines,
                                      LabelPlaces& places) {
    if (lines.cells == nullptr) return {};
    return CellPlanner(lines, places).plan(fonts);
}

void draw_cell_marks(Canvas& canvas, const std::vector<CellMark>& marks, const MapLines& lines) {
    const Point offset = {lines.left, lines.top};
    const double scale = lines.scale;
    Rgba8 halo = lines.shades->halo;
    halo[3] = 255;  // halos that overlap are no darker
    // Adds the lines of one kind of all cells, and draws them over their halos.
    const auto draw = [&](double width, const auto& add) {
        for (const auto& [room, color] :
             {std::pair{halo_room, halo}, std::pair{0.0, lines.shades->text}}) {
            for (const CellMark& mark : marks)
                add(mark);
            canvas.draw_path((width + 2 * room) * scale, color);
        }
    };
    draw(error_width, [&](const CellMark& mark) {
        for (const auto& circle : mark.errors)
            canvas.add_to_path(closed(circle), offset);
    });
    draw(track_width, [&](const CellMark& mark) {
        if (mark.track.size() > 1) canvas.add_to_path(mark.track, offset);
        add_dashes(canvas, mark.ahead, scale, offset);
        for (const auto& tick : mark.ticks)
            canvas.add_to_path(tick, offset);
    });
    draw(ring_width, [&](const CellMark& mark) {
        canvas.add_to_path(ring_about(mark.center, ring_radius * scale), offset);
        if (!mark.top) return;
        canvas.add_to_path({mark.center, *mark.top}, offset);
        canvas.add_to_path(ring_about(*mark.top, scale), offset);
    });
}

}  // namespace stormcellar::render

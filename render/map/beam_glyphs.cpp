#include "render/map/beam_glyphs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/degree.h"
#include "render/map/map_ground.h"
#include "render/view/length_text.h"

namespace stormcellar::render {
namespace {

// Lengths at scale 1, in pixels.
constexpr double px_per_mps = 0.75;
constexpr double lattice_px = 23;
constexpr double disc_radius = 5.2;
// A disc across a flat beam, seen from above, would be a line. So it is drawn a little tilted.
constexpr double disc_tilt = 0.36;
constexpr double head_length = 4.8;
constexpr double head_half_width = 2.6;
constexpr double line_width = 1.4;
constexpr double key_text = 9.5;
constexpr double key_row = 15;

Point moved_along(Point from, Point unit, double length) {
    return {from.x + unit.x * length, from.y + unit.y * length};
}

// The parts of the picture that are taken, as discs.
class TakenDiscs {
  public:
    // Takes the places of a glyph if all are free.
    bool claim(const BeamGlyph& glyph, double radius) {
        const double length = std::hypot(glyph.tip.x - glyph.gate.x, glyph.tip.y - glyph.gate.y);
        const int parts = 1 + static_cast<int>(length / radius);
        std::vector<Point> places;
        for (int i = 0; i <= parts; ++i) {
            const double share = static_cast<double>(i) / parts;
            places.push_back({std::lerp(glyph.gate.x, glyph.tip.x, share),
                              std::lerp(glyph.gate.y, glyph.tip.y, share)});
        }
        const auto is_taken = [&](Point p) {
            return std::ranges::any_of(taken_, [&](Point other) {
                return std::hypot(p.x - other.x, p.y - other.y) < 2 * radius;
            });
        };
        if (std::ranges::any_of(places, is_taken)) return false;
        taken_.insert(taken_.end(), places.begin(), places.end());
        return true;
    }

  private:
    std::vector<Point> taken_;
};

std::vector<Rect> boxes_of(const MapMarks& marks) {
    std::vector<Rect> boxes = {marks.north};
    if (marks.scale_bar) boxes.push_back(marks.scale_bar->box);
    if (marks.glyph_key) boxes.push_back(*marks.glyph_key);
    for (const auto* texts : {&marks.site_texts, &marks.ground_texts}) {
        for (const MarkText& text : *texts)
            boxes.push_back(text.box);
    }
    for (const CellMark& cell : marks.cells)
        if (cell.label) boxes.push_back(cell.label->box);
    return boxes;
}

// Finds the gates under pixels, and the direction of the beam there.
class BeamsOfMap {
  public:
    BeamsOfMap(const grid::SweepLookup& sweep, const MapLines& lines)
        : sweep_(sweep),
          geometry_(*lines.geometry),
          ground_(*lines.spec),
          frame_(sweep.site().latitude_deg, sweep.site().longitude_deg) {}

    // Returns the glyph of the gate at a pixel, or none.
    [[nodiscard]] std::optional<BeamGlyph> at(Point pixel, double scale) const {
        const auto ground = geometry_.ground({pixel.x, pixel.y});
        if (!ground || std::abs(ground->x_m) > geometry_.half_x_m() ||
            std::abs(ground->y_m) > geometry_.half_y_m())
            return std::nullopt;
        const grid::PolarPoint place = frame_.to_polar(ground_.place(*ground));
        const grid::GateValue gate = sweep_.at(place);
        if (gate.status != grid::CellStatus::value) return std::nullopt;
        // The beam passes the pixel between two places half a pixel nearer and farther.
        const double half_m = std::min(0.5 * geometry_.metres_per_pixel(), place.arc_m);
        const Point near = pixel_of({place.azimuth_deg, place.arc_m - half_m});
        const Point far = pixel_of({place.azimuth_deg, place.arc_m + half_m});
        const double length = std::hypot(far.x - near.x, far.y - near.y);
        if (!(length > 0)) return std::nullopt;
        BeamGlyph glyph{
            pixel, {(far.x - near.x) / length, (far.y - near.y) / length}, pixel, gate.value};
        if (std::abs(gate.value) >= BeamGlyph::calm_mps) {
            const double way = glyph_length(std::abs(gate.value), scale);
            glyph.tip = moved_along(pixel, glyph.along, std::copysign(way, gate.value));
        }
        return glyph;
    }

  private:
    [[nodiscard]] Point pixel_of(grid::PolarPoint place) const {
        const GroundPoint at = ground_.ground(frame_.to_geo(place));
        const Pixel pixel = geometry_.project(at.x_m, at.y_m, geometry_.ground_m());
        return {pixel.x, pixel.y};
    }

    const grid::SweepLookup& sweep_;
    const ViewGeometry& geometry_;
    GroundMap ground_;
    grid::SiteFrame frame_;
};

// Returns the outline of the disc across a beam, seen from above.
std::vector<Point> disc_of(const BeamGlyph& glyph, Point offset, double radius) {
    constexpr int corners = 28;
    std::vector<Point> outline;
    outline.reserve(corners);
    for (int i = 0; i < corners; ++i) {
        const double turn = i * (360.0 / corners) * degree;
        const double across = radius * std::cos(turn);
        const double along = radius * disc_tilt * std::sin(turn);
        outline.push_back(
            {offset.x + glyph.gate.x - glyph.along.y * across + glyph.along.x * along,
             offset.y + glyph.gate.y + glyph.along.x * across + glyph.along.y * along});
    }
    return outline;
}

// Returns the triangle at the tip, `room` larger on all sides. A short line has a small head.
std::vector<Point> head_of(const BeamGlyph& glyph, Point offset, double scale, double room) {
    const double length = std::hypot(glyph.tip.x - glyph.gate.x, glyph.tip.y - glyph.gate.y);
    const double size = std::min(1.0, 0.5 + 0.5 * length / (head_length * scale));
    const Point unit = {(glyph.tip.x - glyph.gate.x) / length,
                        (glyph.tip.y - glyph.gate.y) / length};
    const Point tip =
        moved_along({glyph.tip.x + offset.x, glyph.tip.y + offset.y}, unit, 1.6 * room);
    const Point back = moved_along(tip, unit, -(head_length * size * scale + 2.6 * room));
    const double half = head_half_width * size * scale + 1.3 * room;
    return {tip, moved_along(back, {-unit.y, unit.x}, half),
            moved_along(back, {unit.y, -unit.x}, half)};
}

bool is_calm(const BeamGlyph& glyph) {
    return glyph.tip.x == glyph.gate.x && glyph.tip.y == glyph.gate.y;
}

std::vector<Point> dot_at(Point middle, double radius) {
    std::vector<Point> dot;
    for (int i = 0; i < 12; ++i)
        dot.push_back(
            moved_along(middle, {std::cos(i * 30 * degree), std::sin(i * 30 * degree)}, radius));
    return dot;
}

void draw_discs(Canvas& canvas, const std::vector<BeamGlyph>& glyphs, const MapLines& lines) {
    const auto text_with = [&](std::uint8_t alpha) {
        Rgba8 color = lines.shades->text;
        color[3] = alpha;
        return color;
    };
    for (const BeamGlyph& glyph : glyphs) {
        const auto disc = disc_of(glyph, {lines.left, lines.top}, disc_radius * lines.scale);
        canvas.line(disc, 2.2 * lines.scale, lines.shades->casing, true);
        canvas.fill(disc, text_with(70));
        canvas.line(disc, 0.8 * lines.scale, text_with(190), true);
    }
}

void draw_lines(Canvas& canvas, const std::vector<BeamGlyph>& glyphs, const MapLines& lines) {
    const Point offset = {lines.left, lines.top};
    const auto draw = [&](double room, Rgba8 color) {
        for (const BeamGlyph& glyph : glyphs) {
            if (is_calm(glyph)) continue;
            // The line ends inside its head, so that the head stays sharp.
            canvas.add_to_path({glyph.gate,
                                {std::lerp(glyph.tip.x, glyph.gate.x, 0.1),
                                 std::lerp(glyph.tip.y, glyph.gate.y, 0.1)}},
                               offset);
        }
        canvas.draw_path(line_width * lines.scale + 2 * room, color);
        for (const BeamGlyph& glyph : glyphs) {
            const Point gate = {glyph.gate.x + offset.x, glyph.gate.y + offset.y};
            canvas.fill(is_calm(glyph) ? dot_at(gate, 1.5 * lines.scale + room)
                                       : head_of(glyph, offset, lines.scale, room),
                        color);
        }
    };
    Rgba8 halo = lines.shades->halo;
    halo[3] = 255;  // halos that overlap are no darker
    draw(0.9 * lines.scale, halo);
    draw(0, lines.shades->text);
}

}  // namespace

double glyph_length(double speed_mps, double scale) {
    return px_per_mps * scale * speed_mps;
}

std::vector<BeamGlyph> plan_beam_glyphs(const grid::SweepLookup& sweep, const MapLines& lines,
                                        const MapMarks& marks) {
    const BeamsOfMap beams(sweep, lines);
    const std::vector<Rect> boxes = boxes_of(marks);
    const double step = lattice_px * lines.scale;
    const double radius = disc_radius * lines.scale;
    const double width = lines.geometry->width();
    const double height = lines.geometry->height();
    const auto is_free = [&](Point p) {
        return p.x >= radius && p.y >= radius && p.x <= width - radius && p.y <= height - radius &&
               std::ranges::none_of(boxes, [&](const Rect& box) {
                   return p.x > box.x - radius && p.x < box.right() + radius &&
                          p.y > box.y - radius && p.y < box.bottom() + radius;
               });
    };
    TakenDiscs taken;
    std::vector<BeamGlyph> glyphs;
    for (int row = 0; (row + 0.5) * step < height; ++row) {
        // Every other row is moved by half a step, which hides the rows.
        for (double x = step * (row % 2 == 0 ? 0.5 : 1); x < width; x += step) {
            const auto glyph = beams.at({x, (row + 0.5) * step}, lines.scale);
            if (!glyph || !is_free(glyph->gate) || !is_free(glyph->tip)) continue;
            if (taken.claim(*glyph, 0.7 * radius)) glyphs.push_back(*glyph);
        }
    }
    return glyphs;
}

void draw_beam_glyphs(Canvas& canvas, const std::vector<BeamGlyph>& glyphs, const MapLines& lines) {
    clip_to_picture(canvas, lines);
    draw_discs(canvas, glyphs, lines);
    draw_lines(canvas, glyphs, lines);
    canvas.unclip();
}

GlyphKey glyph_key(const Units& units) {
    const ShownUnit unit = shown_unit("m/s", units);
    // The round speed nearest to 20 m/s: 20 m/s, 40 kt, 40 mph or 70 km/h.
    const double shown = 10 * std::round(2 * unit.per_stored);
    GlyphKey key;
    key.speed_mps = shown / unit.per_stored;
    key.along = number_text(shown) + " " + unit.symbol + " along the beam";
    key.across = "wind across the beam: not observed";
    return key;
}

Point size_of_glyph_key(const Fonts& fonts, const Units& units, double scale) {
    const GlyphKey key = glyph_key(units);
    const double text = std::max(fonts.width(key.along, key_text * scale, false),
                                 fonts.width(key.across, key_text * scale, false));
    const double line = glyph_length(key.speed_mps, scale);
    return {line + text + (2 * disc_radius + 16) * scale, (2 * key_row + 8) * scale};
}

void draw_glyph_key(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const Rect& box) {
    const GlyphKey key = glyph_key(lines.units);
    const double scale = lines.scale;
    Rgba8 ground = lines.shades->page;
    ground[3] = 170;
    canvas.fill(Rect{box.x + lines.left, box.y + lines.top, box.width, box.height}, ground);
    const double length = glyph_length(key.speed_mps, scale);
    const double left = box.x + (disc_radius + 2) * scale;
    const auto row_y = [&](int row) { return box.y + (4 + key_row * (row + 0.5)) * scale; };
    draw_lines(canvas, {{{left, row_y(0)}, {1, 0}, {left + length, row_y(0)}, 0}}, lines);
    draw_discs(canvas, {{{left + length / 2, row_y(1)}, {1, 0}, {}, 0}}, lines);
    for (int row = 0; row < 2; ++row) {
        canvas.text(fonts, row == 0 ? key.along : key.across,
                    {lines.left + left + length + 9 * scale,
                     lines.top + row_y(row) + 0.36 * key_text * scale},
                    key_text * scale, false, lines.shades->text, lines.shades->halo);
    }
}

}  // namespace stormcellar::render

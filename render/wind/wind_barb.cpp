#include "render/wind/wind_barb.h"

#include <cmath>

#include "base/degree.h"
#include "stormcellar/render/units.h"

namespace stormcellar::render {
namespace {

constexpr double barb_share = 0.42;  // length of a long barb, as a share of the staff
constexpr double step_share = 0.15;  // from one barb to the next, as a share of the staff
constexpr double flag_share = 0.22;  // base of a flag, as a share of the staff

}  // namespace

BarbParts barb_parts(double knots) {
    const long fives = std::lround(knots / 5);
    return {static_cast<int>(fives / 10), static_cast<int>(fives % 10 / 2),
            static_cast<int>(fives % 2)};
}

void draw_wind_barb(Canvas& canvas, Point place, const retrieve::Motion& wind, double length,
                    double line_width, Rgba8 color) {
    const BarbParts parts = barb_parts(wind.speed_mps() / facts_of(Unit::knots).si);
    if (parts.flags + parts.long_barbs + parts.short_barbs == 0) {
        std::vector<Point> circle;
        for (int i = 0; i < 16; ++i)
            circle.push_back({place.x + 0.15 * length * std::sin(i * 22.5 * degree),
                              place.y - 0.15 * length * std::cos(i * 22.5 * degree)});
        canvas.line(circle, line_width, color, true);
        return;
    }
    const double from = wind.direction_deg() * degree;
    const Point along{std::sin(from), -std::cos(from)}, right{std::cos(from), std::sin(from)};
    const auto at = [&](double out, double aside) {
        return Point{place.x + (out * along.x + aside * right.x) * length,
                     place.y + (out * along.y + aside * right.y) * length};
    };
    canvas.line({place, at(1, 0)}, line_width, color, false);
    double out = 1;
    for (int i = 0; i < parts.flags; ++i) {
        canvas.fill({at(out, 0), at(out, barb_share), at(out - flag_share, 0)}, color);
        out -= flag_share;
    }
    if (parts.flags > 0) out -= step_share / 2;
    for (int i = 0; i < parts.long_barbs; ++i) {
        canvas.line({at(out, 0), at(out + step_share, barb_share)}, line_width, color, false);
        out -= step_share;
    }
    if (parts.short_barbs == 0) return;
    // A single short barb stays away from the end, so that it does not look like a long barb.
    if (parts.flags + parts.long_barbs == 0) out -= step_share;
    canvas.line({at(out, 0), at(out + step_share / 2, barb_share / 2)}, line_width, color, false);
}

}  // namespace stormcellar::render

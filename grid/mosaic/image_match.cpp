#include "grid/mosaic/image_match.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stormcellar::grid {
namespace {

struct Correlation {
    double value = -1;
    std::size_t echoes = 0;
};

Correlation correlate(const EchoImage& before, const EchoImage& after, const PixelBox& box, int dx,
                      int dy) {
    // The operator >> rounds toward minus infinity. The other image moves by the rest, dx - back_x.
    const int back_x = dx >> 1, back_y = dy >> 1;
    double n = 0, sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
    std::size_t echoes = 0;
    for (int y = box.y0; y < box.y1; ++y) {
        const int ya = y - back_y, yb = ya + dy;
        if (std::min(ya, yb) < 0 || std::max(ya, yb) >= before.height) continue;
        for (int x = box.x0; x < box.x1; ++x) {
            const int xa = x - back_x, xb = xa + dx;
            if (std::min(xa, xb) < 0 || std::max(xa, xb) >= before.width) continue;
            const std::size_t at_a = before.index(xa, ya), at_b = after.index(xb, yb);
            if (before.seen[at_a] == 0 || after.seen[at_b] == 0) continue;
            const auto a = static_cast<double>(before.echo_db[at_a]);
            const auto b = static_cast<double>(after.echo_db[at_b]);
            n += 1;
            if (a == 0 && b == 0) continue;
            ++echoes;
            sum_a += a;
            sum_b += b;
            sum_aa += a * a;
            sum_bb += b * b;
            sum_ab += a * b;
        }
    }
    const double spread_a = n * sum_aa - sum_a * sum_a;
    const double spread_b = n * sum_bb - sum_b * sum_b;
    if (!(spread_a > 0) || !(spread_b > 0)) return {-1, echoes};
    return {(n * sum_ab - sum_a * sum_b) / std::sqrt(spread_a * spread_b), echoes};
}

// Returns the place of the top of a parabola. It goes through three values, at -1, 0 and 1; the
// middle value is the greatest.
double top_of_parabola(double before, double middle, double after) {
    const double curvature = before - 2 * middle + after;
    if (!(curvature < 0)) return 0;
    return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

class Search {
  public:
    Search(const EchoImage& before, const EchoImage& after, const PixelBox& box,
           const ShiftSearch& search)
        : search_(search), width_(2 * search.reach_x + 1) {
        for (int dy = -search.reach_y; dy <= search.reach_y; ++dy) {
            for (int dx = -search.reach_x; dx <= search.reach_x; ++dx) {
                all_.push_back(
                    correlate(before, after, box, search.around_x + dx, search.around_y + dy));
            }
        }
    }

    // Returns the best shift. If several are equally good, returns the shortest, because an image
    // that does not change has not moved.
    [[nodiscard]] std::optional<Shift> best() const {
        std::optional<Shift> best;
        for (int dy = -search_.reach_y; dy <= search_.reach_y; ++dy) {
            for (int dx = -search_.reach_x; dx <= search_.reach_x; ++dx) {
                const Correlation& found = at(dx, dy);
                if (!(found.value > 0)) continue;
                const double x = search_.around_x + dx, y = search_.around_y + dy;
                const bool better = !best || found.value > best->correlation ||
                                    (found.value == best->correlation &&
                                     x * x + y * y < best->x * best->x + best->y * best->y);
                if (better) best = Shift{x, y, found.value, found.echoes};
            }
        }
        if (best) refine(*best);
        return best;
    }

  private:
    [[nodiscard]] const Correlation& at(int dx, int dy) const {
        const int shift = (dy + search_.reach_y) * width_ + dx + search_.reach_x;
        return all_[static_cast<std::size_t>(shift)];
    }
    void refine(Shift& shift) const {
        const int dx = static_cast<int>(shift.x) - search_.around_x;
        const int dy = static_cast<int>(shift.y) - search_.around_y;
        if (std::abs(dx) < search_.reach_x) {
            shift.x +=
                top_of_parabola(at(dx - 1, dy).value, shift.correlation, at(dx + 1, dy).value);
        }
        if (std::abs(dy) < search_.reach_y) {
            shift.y +=
                top_of_parabola(at(dx, dy - 1).value, shift.correlation, at(dx, dy + 1).value);
        }
    }

    ShiftSearch search_;
    int width_;
    std::vector<Correlation> all_;
};

}  // namespace

std::optional<Shift> best_shift(const EchoImage& before, const EchoImage& after,
                                const PixelBox& box, const ShiftSearch& search) {
    return Search(before, after, box, search).best();
}

}  // namespace stormcellar::grid

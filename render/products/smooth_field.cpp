#include "render/products/smooth_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/sweep/mixture.h"

namespace stormcellar::render {
namespace {

// Returns the weights of four neighbors for a place between the middle two, at a share of the way.
std::array<float, 4> cubic_weights(float t) {
    const float t2 = t * t, t3 = t2 * t;
    return {0.5F * (-t + 2 * t2 - t3), 0.5F * (2 - 5 * t2 + 3 * t3), 0.5F * (t + 4 * t2 - 3 * t3),
            0.5F * (t3 - t2)};
}

}  // namespace

bool is_smoothed(const Scene& scene) {
    const grid::Blending blending = grid::blending_of(scene.moment);
    const bool wraps =
        blending == grid::Blending::nyquist_circle || blending == grid::Blending::phase_circle;
    return scene.smooth && facts_of(scene.product).is_smooth && !wraps;
}

SmoothField::Place SmoothField::at(double x, double y) const {
    using grid::CellStatus;
    const double held_x = std::clamp(x, 0.0, field_.width - 1.0);
    const double held_y = std::clamp(y, 0.0, field_.height - 1.0);
    const int west = std::min(static_cast<int>(held_x), std::max(0, field_.width - 2));
    const int south = std::min(static_cast<int>(held_y), std::max(0, field_.height - 2));
    const auto beyond_x = static_cast<float>(held_x - west);
    const auto beyond_y = static_cast<float>(held_y - south);
    const int east = std::min(west + 1, field_.width - 1);
    const int north = std::min(south + 1, field_.height - 1);
    const std::array<std::size_t, 4> cells = {field_.index(west, south), field_.index(east, south),
                                              field_.index(west, north), field_.index(east, north)};
    const std::array<float, 4> weights = {(1 - beyond_x) * (1 - beyond_y),
                                          beyond_x * (1 - beyond_y), (1 - beyond_x) * beyond_y,
                                          beyond_x * beyond_y};
    float valued = 0;
    bool all_known = true;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const CellStatus status = field_.status[cells[c]];
        if (status == CellStatus::value) valued += weights[c];
        all_known = all_known && (status == CellStatus::value || status == CellStatus::no_echo);
    }
    const auto nearest = (beyond_x >= 0.5F ? 1U : 0U) + (beyond_y >= 0.5F ? 2U : 0U);
    CellStatus status = field_.status[cells[nearest]];
    if (all_known) status = valued >= 0.5F ? CellStatus::value : CellStatus::no_echo;
    if (status != CellStatus::value) return {status, 0};
    return {status, value_at(west, south, beyond_x, beyond_y)};
}

// Returns the value between the cells (x, y) and (x + 1, y + 1). At least one of these four cells
// has a value.
float SmoothField::value_at(int x, int y, float beyond_x, float beyond_y) const {
    // The 4 x 4 cells, row by row. Beyond the edge of the field, the cells at the edge are
    // repeated.
    std::array<float, 16> values;
    std::array<bool, 16> known;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const std::size_t cell = field_.index(std::clamp(x - 1 + column, 0, field_.width - 1),
                                                  std::clamp(y - 1 + row, 0, field_.height - 1));
            const auto k = static_cast<std::size_t>(4 * row + column);
            known[k] = field_.status[cell] == grid::CellStatus::value;
            values[k] = field_.values[cell];
        }
    }
    // The result stays within the range of the middle four cells. Of these four, each cell without
    // a value gets the mean of the cells with a value.
    constexpr std::array<std::size_t, 4> middle = {5, 6, 9, 10};
    float sum = 0, count = 0, least = 0, largest = 0;
    for (const std::size_t k : middle) {
        if (!known[k]) continue;
        least = count > 0 ? std::min(least, values[k]) : values[k];
        largest = count > 0 ? std::max(largest, values[k]) : values[k];
        sum += values[k];
        count += 1;
    }
    for (const std::size_t k : middle) {
        if (!known[k]) values[k] = sum / count;
    }
    const std::array<float, 4> across = cubic_weights(beyond_x), up = cubic_weights(beyond_y);
    float mixed = 0;
    for (std::size_t row = 0; row < 4; ++row) {
        float in_row = 0;
        for (std::size_t column = 0; column < 4; ++column) {
            const std::size_t k = 4 * row + column;
            const std::size_t nearest =
                4 * std::clamp<std::size_t>(row, 1, 2) + std::clamp<std::size_t>(column, 1, 2);
            in_row += across[column] * (known[k] ? values[k] : values[nearest]);
        }
        mixed += up[row] * in_row;
    }
    return std::clamp(mixed, least, largest);
}

}  // namespace stormcellar::render

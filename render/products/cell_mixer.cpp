#include "render/products/cell_mixer.h"

#include <algorithm>

#include "base/floating_point.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

using grid::CellStatus;

grid::Sample cell_of(const grid::BrickView& view, float half_period, int ix, int iy, int iz) {
    grid::Sample cell;
    cell.status = view.status(ix, iy, iz);
    if (cell.status == CellStatus::value) cell.value = view.value(ix, iy, iz);
    cell.half_period = half_period;
    return cell;
}

CellMixer::CellMixer(level2::Moment moment)
    : blending_(moment == level2::Moment::ref ? grid::Blending::values_only
                                              : grid::blending_of(moment)) {}

void CellMixer::add(const grid::Sample& cell, double weight) {
    if (weight > 0 && count_ < parts_.size()) {
        parts_[count_++] = {cell, static_cast<float>(weight)};
    }
}

grid::CellResult CellMixer::result() const {
    const auto end = parts_.begin() + static_cast<std::ptrdiff_t>(count_);
    // Add the value with the largest weight first: for values that wrap, the mixture takes
    // differences from the first value and uses its period.
    const auto weighs_less = [](const Part& a, const Part& b) {
        const bool a_counts = a.cell.status == CellStatus::value;
        const bool b_counts = b.cell.status == CellStatus::value;
        return a_counts != b_counts ? b_counts : a.weight < b.weight;
    };
    const auto heaviest = std::max_element(parts_.begin(), end, weighs_less);
    grid::Mixture mixture;
    if (heaviest != end) mixture.add(heaviest->cell, heaviest->weight, blending_);
    for (auto part = parts_.begin(); part != end; ++part) {
        if (part != heaviest) mixture.add(part->cell, part->weight, blending_);
    }
    return mixture.result(blending_);
}

Result<LevelPair> levels_about(const grid::GridSpec& spec, double height_m) {
    const HeightRange range = height_range(spec);
    if (!is_within(height_m, range.bottom_m, range.top_m)) {
        return fail(
            ErrorCode::bad_argument,
            "the grid has no cells at a height of {} km; its cells lie from {:g} to {:g} km",
            height_m / 1000, range.bottom_m / 1000, range.top_m / 1000);
    }
    const auto& levels = spec.levels_m;
    const auto above = std::lower_bound(levels.begin(), levels.end(), height_m);
    const int upper = static_cast<int>(above - levels.begin());
    if (above == levels.end()) return LevelPair{upper - 1, upper - 1, 0};
    if (above == levels.begin() || *above <= height_m) return LevelPair{upper, upper, 0};
    const double below_m = *(above - 1);
    return LevelPair{upper - 1, upper, (height_m - below_m) / (*above - below_m)};
}

}  // namespace stormcellar::render

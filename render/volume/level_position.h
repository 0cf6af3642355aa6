// render/volume/level_position.h -- converts a height into a position among the levels, which may
// have a fraction.
//
// The position 2.25 is a quarter of the way from level 2 to level 3. Below the first level the
// position is 0, and above the last it is nz - 1. If levels are evenly spaced, one multiplication
// is enough. Otherwise, a table of buckets leads to the interval in a few steps.
//
// Accuracy  Single precision, 1e-3 of a level over 1,024 levels.
// Threads   Immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::render {

class LevelPosition {
  public:
    // Heights are first multiplied by `exaggeration`.
    LevelPosition(const grid::GridSpec& spec, double exaggeration);

    [[nodiscard]] bool is_uniform() const { return uniform_; }
    // For evenly spaced levels, position = offset + slope * height.
    [[nodiscard]] double offset() const { return offset_; }
    [[nodiscard]] double slope() const { return slope_; }

    [[nodiscard]] float operator()(float height) const {
        if (!(height > levels_.front())) return 0;
        if (height >= levels_.back()) return static_cast<float>(levels_.size() - 1);
        std::size_t i =
            buckets_[static_cast<std::size_t>((height - levels_.front()) * buckets_per_metre_)];
        while (height >= levels_[i + 1])
            ++i;
        return static_cast<float>(i) + (height - levels_[i]) / (levels_[i + 1] - levels_[i]);
    }

  private:
    bool uniform_ = true;
    double offset_ = 0, slope_ = 0;
    std::vector<float> levels_;
    std::vector<std::uint16_t> buckets_;  // the interval that holds the lower end of each bucket
    float buckets_per_metre_ = 0;
};

}  // namespace stormcellar::render

// grid/cells/level_table.h -- the levels of a grid, and a search for the level at a height.
//
// A lookup starts from a table of equal steps and then searches along the levels, so it is exact.
//
// Threads   Immutable.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace stormcellar::grid {

class LevelTable {
  public:
    // The levels must rise; there must be at least one.
    explicit LevelTable(std::vector<float> levels_m)
        : levels_m_(std::move(levels_m)),
          steps_(static_cast<float>(steps_a_level * levels_m_.size())),
          steps_per_m_(levels_m_.size() > 1 ? steps_ / (levels_m_.back() - levels_m_.front()) : 0) {
        std::uint32_t level = 0;
        const std::size_t steps = steps_a_level * levels_m_.size();
        first_of_step_.reserve(steps + 1);
        for (std::size_t step = 0; step <= steps; ++step) {
            // Begin each step half a step lower, so that a lookup cannot skip a level because of
            // rounding.
            const float begin = static_cast<float>(step) - 0.5F;
            while (level + 1 < levels_m_.size() && step_of(levels_m_[level]) < begin)
                ++level;
            first_of_step_.push_back(level);
        }
    }

    [[nodiscard]] std::span<const float> levels_m() const { return levels_m_; }
    [[nodiscard]] std::size_t size() const { return levels_m_.size(); }
    [[nodiscard]] float operator[](std::size_t level) const { return levels_m_[level]; }
    [[nodiscard]] float top_m() const { return levels_m_.back(); }

    // Returns the first level at or above a height; size() if there is none.
    [[nodiscard]] std::size_t first_from(float height_m) const {
        if (height_m > levels_m_.back()) return levels_m_.size();
        if (height_m <= levels_m_.front()) return 0;
        const auto step = static_cast<std::size_t>(step_of(height_m));
        std::size_t level = first_of_step_[step];
        while (levels_m_[level] < height_m)
            ++level;
        return level;
    }

  private:
    static constexpr std::size_t steps_a_level = 8;

    [[nodiscard]] float step_of(float height_m) const {
        return std::min(steps_, (height_m - levels_m_.front()) * steps_per_m_);
    }

    std::vector<float> levels_m_;
    float steps_;
    float steps_per_m_;
    std::vector<std::uint32_t> first_of_step_;
};

}  // namespace stormcellar::grid

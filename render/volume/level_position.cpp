#include "render/volume/level_position.h"

#include <cmath>

namespace stormcellar::render {
namespace {

constexpr std::size_t bucket_count = 1024;
constexpr double uniform_tolerance = 1e-6;  // as a share of the spacing

}  // namespace

LevelPosition::LevelPosition(const grid::GridSpec& spec, double exaggeration) {
    const auto& heights = spec.levels_m;
    const std::size_t last = heights.size() - 1;
    for (const double height : heights) {
        levels_.push_back(static_cast<float>(height * exaggeration));
    }
    const double span = heights[last] - heights[0];
    if (last > 0) {
        const double spacing = span / static_cast<double>(last);
        for (std::size_t i = 0; i <= last; ++i) {
            const double even = heights[0] + spacing * static_cast<double>(i);
            if (std::abs(heights[i] - even) > uniform_tolerance * spacing) uniform_ = false;
        }
        slope_ = 1 / (spacing * exaggeration);
        offset_ = -heights[0] / spacing;
    }
    // One extra bucket is for heights that rounding puts after the last bucket.
    buckets_.assign(bucket_count + 1, 0);
    if (span <= 0) return;
    const double bucket = span * exaggeration / bucket_count;
    buckets_per_metre_ = static_cast<float>(1 / bucket);
    std::size_t level = 0;
    for (std::size_t i = 1; i <= bucket_count; ++i) {
        // The index starts one bucket lower, so that rounding never makes it too high.
        const double low = heights[0] * exaggeration + (static_cast<double>(i) - 1) * bucket;
        while (level + 1 < last && low >= static_cast<double>(levels_[level + 1]))
            ++level;
        buckets_[i] = static_cast<std::uint16_t>(level);
    }
}

}  // namespace stormcellar::render

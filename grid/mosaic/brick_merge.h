// grid/mosaic/brick_merge.h -- merges one brick of several sites, by the rules of
// stormcellar/grid/mosaic.h.
//
// Threads: a BrickMerger belongs to one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "grid/beam/detection_limit.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

// What a rule weighs a site by in the columns of one brick.
struct LayerColumns {
    ColumnValues weights{};
    ColumnValues squared_arcs_m2{};
};

// A site's brick at the place that is merged.
struct BrickLayer {
    const BrickView* view = nullptr;
    std::size_t brick = 0;  // in that view
    const LayerColumns* columns = nullptr;
    DetectionLimit limit;
    double site_altitude_m = 0;
};

// The codes of a layer, 16 up each column.
template <class Code>
struct LayerCodes {
    const Code* first = nullptr;
    std::size_t stride = brick_edge;  // 0: every column alike
    [[nodiscard]] const Code* column(std::size_t at) const { return first + at * stride; }
};

// What the cells of a brick come to.
template <class Code>
struct MergedBrick {
    alignas(64) std::array<Code, brick_cells> codes{};
    alignas(64) std::array<std::uint8_t, brick_cells> counts{};
    alignas(64) std::array<std::uint16_t, brick_cells> weights{};
};

inline constexpr Quantization count_quantization{1, 1, 1};
inline constexpr Quantization weight_quantization{2, 0, 1.0F / 1024};

// Code is std::uint8_t or std::uint16_t, as the views have it.
template <class Code>
class BrickMerger {
  public:
    BrickMerger(const MosaicOptions& options, const Quantization& quantization);

    // The layers in the order in which they are summed, none of which may be uniformly not seen;
    // `levels_m` are those of the brick. The result is valid until the next call.
    const MergedBrick<Code>& merge(std::span<const BrickLayer> layers, const BrickExtent& extent,
                                   std::span<const double> levels_m);
    // Counts and weights alone.
    const MergedBrick<Code>& count(std::span<const BrickLayer> layers, const BrickExtent& extent);

    // Means that were below the least code, so far.
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_; }

  private:
    // Sums of 1-byte codes are exact enough in floats, of 2-byte ones in doubles.
    using Real = std::conditional_t<sizeof(Code) == 1, float, double>;
    using Word = std::conditional_t<sizeof(Code) == 1, std::int32_t, std::int64_t>;  // as long

    // What a layer's "no echo" stands for: scale * (arc^2 + (height - altitude)^2) is Z at its
    // detection limit.
    struct Limit {
        Real scale = 0;
        std::array<Real, brick_edge> squared_heights_m2{};
    };

    // Of the lowest cells of a column.
    template <std::size_t size>
    struct Sums {
        std::array<Real, size> value{}, no_echo{}, folded{};  // weights
        std::array<Real, size> sum{};                         // of weight times value
    };
    // A layer that sees something of a column.
    struct Active {
        std::size_t layer;
        unsigned states;
        const Code* codes;
    };

    void open(std::span<const BrickLayer> layers, const BrickExtent& extent);
    void open_limits(std::span<const BrickLayer> layers, std::span<const double> levels_m);
    void find_active(std::size_t column);
    template <std::size_t size>
    void merge_mean(std::span<const BrickLayer> layers, std::size_t column, int height);
    template <std::size_t size>
    void add(const BrickLayer& layer, const Active& active, std::size_t column,
             Sums<size>& sums) const;
    template <std::size_t size>
    void find_limits(const BrickLayer& layer, const Limit& limit, std::size_t column,
                     std::array<Real, size>& limits) const;
    template <std::size_t size>
    void finish_mean(const Sums<size>& sums, Code* to, int height);
    void merge_maximum(std::size_t column, int height);
    void merge_nearest(std::span<const BrickLayer> layers, std::size_t column, int height);

    const MosaicOptions options_;
    const Quantization quantization_;
    bool in_z_, with_limits_;
    Real code_per_log2_, code_base_;  // from log2 of Z to a code
    std::vector<Real> linear_;        // of a code: Z, or the code itself
    std::vector<LayerCodes<Code>> codes_;
    std::vector<Limit> limits_;
    std::vector<std::vector<Code>> unpacked_;
    std::vector<std::size_t> order_;  // nearest first
    std::vector<Active> active_;      // of the column at hand
    unsigned states_ = 0;             // of all that are active
    MergedBrick<Code> merged_;
    std::uint64_t clamped_ = 0;
};

}  // namespace stormcellar::grid

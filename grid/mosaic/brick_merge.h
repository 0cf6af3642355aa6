// grid/mosaic/brick_merge.h -- merges one brick of several sites by the rules of
// stormcellar/grid/mosaic.h.
//
// The merger goes through the brick column by column. The 16 codes of a column are contiguous, so
// each step is a loop over 16 numbers, which the compiler turns into vector instructions. The
// weight of a site is the same for all cells of a column.
//
// Threads   One thread at a time may use a BrickMerger.
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

// The weight and the squared distance of a site in each column of one brick.
struct LayerColumns {
    ColumnValues weights{};
    ColumnValues squared_arcs_m2{};
};

// The brick of one site that covers the same cells as the merged brick.
struct BrickLayer {
    const BrickView* view = nullptr;
    std::size_t brick = 0;  // number of the brick in `view`
    const LayerColumns* columns = nullptr;
    DetectionLimit limit;
    double site_altitude_m = 0;
};

// The codes of a layer, 16 for each column.
template <class Code>
struct LayerCodes {
    const Code* first = nullptr;
    std::size_t stride = brick_edge;  // distance between columns; 0: all columns are equal
    [[nodiscard]] const Code* column(std::size_t at) const { return first + at * stride; }
};

// The cells of the merged brick.
template <class Code>
struct MergedBrick {
    alignas(64) std::array<Code, brick_cells> codes{};
    alignas(64) std::array<std::uint8_t, brick_cells> counts{};
    alignas(64) std::array<std::uint16_t, brick_cells> weights{};
};

inline constexpr Quantization count_quantization{1, 1, 1};
inline constexpr Quantization weight_quantization{2, 0, 1.0F / 1024};

// Code is std::uint8_t or std::uint16_t, as in the views.
template <class Code>
class BrickMerger {
  public:
    BrickMerger(const MosaicOptions& options, const Quantization& quantization);

    // Merges the layers. They are summed in the given order. A layer whose brick is all not seen
    // must be left out. `levels_m` are the levels of the brick. The result is valid until the next
    // call.
    const MergedBrick<Code>& merge(std::span<const BrickLayer> layers, const BrickExtent& extent,
                                   std::span<const double> levels_m);
    // Computes only the counts and the weights.
    const MergedBrick<Code>& count(std::span<const BrickLayer> layers, const BrickExtent& extent);

    // Returns how many means so far were below the smallest code.
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_; }

  private:
    // Floats are exact enough to sum 1-byte codes, and doubles to sum 2-byte codes.
    using Real = std::conditional_t<sizeof(Code) == 1, float, double>;
    // An integer of the size of Real.
    using Word = std::conditional_t<sizeof(Code) == 1, std::int32_t, std::int64_t>;

    // A layer's detection limit, which is the value of its "no echo" in a mean. As Z, it is scale *
    // (arc^2 + (height - altitude)^2).
    struct Limit {
        Real scale = 0;
        std::array<Real, brick_edge> squared_heights_m2{};
    };

    // The sums for the lowest `size` cells of a column.
    template <std::size_t size>
    struct Sums {
        std::array<Real, size> value{}, no_echo{}, folded{};  // sums of weights
        std::array<Real, size> sum{};                         // sum of weight times value
    };
    // A layer that sees something in the present column.
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
    Real code_per_log2_, code_base_;  // turn log2 of Z into a code
    std::vector<Real> linear_;        // Z by code; empty if codes are averaged
    std::vector<LayerCodes<Code>> codes_;
    std::vector<Limit> limits_;
    std::vector<std::vector<Code>> unpacked_;
    std::vector<std::size_t> order_;  // nearest first
    std::vector<Active> active_;      // layers that see something in the present column
    unsigned states_ = 0;             // the states of all active layers
    MergedBrick<Code> merged_;
    std::uint64_t clamped_ = 0;
};

}  // namespace stormcellar::grid

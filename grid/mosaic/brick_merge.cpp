#include "grid/mosaic/brick_merge.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "grid/beam/fast_log.h"
#include "grid/cells/moment_rules.h"

namespace stormcellar::grid {
namespace {

constexpr double db_per_log2 = 3.0102999566398120;  // 10 log10(2)
constexpr double nearest_range_m2 = 100.0 * 100.0;  // as in grid/beam/detection_limit.h

// The last bricks of a grid often have at most this many levels. Shorter loops merge these bricks.
constexpr int few = 4;

// The states that occur in the sixteen codes of a column, as bits. The codes of no echo (1) and
// range folded (2) are these bits themselves, so an "or" over the column finds the states without a
// branch.
constexpr unsigned has_no_echo = 1;
constexpr unsigned has_folded = 2;
constexpr unsigned has_value = 4;
template <class Code>
unsigned states_in(const Code* codes) {
    Code states = 0;
    for (int z = 0; z < brick_edge; ++z)
        states |= codes[z] < first_value_code ? codes[z] : Code{has_value};
    return states;
}

// Columns of sixteen cells that all have one state. A uniform brick has no codes in memory, so all
// of its columns point to one of these arrays.
template <class Code>
constexpr std::array<std::array<Code, brick_edge>, 3> columns_of_states = [] {
    std::array<std::array<Code, brick_edge>, 3> columns{};
    columns[1].fill(1);
    columns[2].fill(2);
    return columns;
}();

template <class Code>
void unpack_states(std::span<const std::byte> packed, std::vector<Code>& codes) {
    codes.resize(brick_cells);
    Code* to = codes.data();
    for (const std::byte four_cells : packed) {
        const auto bits = std::to_integer<unsigned>(four_cells);
        for (unsigned shift = 0; shift < 8; shift += 2)
            *to++ = static_cast<Code>((bits >> shift) & 3U);
    }
}

// Calls work(column) for each column of the extent.
template <class Work>
void for_each_column(const BrickExtent& extent, Work work) {
    for (int x = 0; x < extent.x; ++x) {
        for (int y = 0; y < extent.y; ++y) {
            const int column = x * brick_edge + y;
            work(static_cast<std::size_t>(column));
        }
    }
}

}  // namespace

template <class Code>
BrickMerger<Code>::BrickMerger(const MosaicOptions& options, const Quantization& quantization)
    : options_(options),
      quantization_(quantization),
      in_z_(options.averaging == Averaging::in_z),
      with_limits_(rules_of(options.moment).has_detection_limit),
      code_per_log2_(static_cast<Real>(db_per_log2 / static_cast<double>(quantization.step))),
      code_base_(
          static_cast<Real>(first_value_code - static_cast<double>(quantization.first_value) /
                                                   static_cast<double>(quantization.step))) {
    if (!in_z_) return;
    linear_.resize(std::size_t{quantization.largest_code()} + 1);
    for (std::size_t code = first_value_code; code < linear_.size(); ++code) {
        const double dbz =
            static_cast<double>(quantization.first_value) +
            static_cast<double>(quantization.step) * static_cast<double>(code - first_value_code);
        linear_[code] = static_cast<Real>(std::pow(10.0, dbz / 10));
    }
}

// Finds the codes of each layer. Stored codes are used in place, packed states are unpacked, and a
// uniform brick becomes a constant column. So the rules can treat all layers alike.
template <class Code>
void BrickMerger<Code>::open(std::span<const BrickLayer> layers, const BrickExtent& extent) {
    codes_.resize(layers.size());
    unpacked_.resize(std::max(unpacked_.size(), layers.size()));
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const BrickView& view = *layers[i].view;
        const BrickEntry& entry = view.bricks[layers[i].brick];
        if (entry.kind == BrickKind::stored) {
            codes_[i] = {reinterpret_cast<const Code*>(view.codes.data()) +
                         layers[i].brick * brick_cells};
        } else if (entry.kind == BrickKind::status_only) {
            unpack_states(
                view.states.subspan(entry.status_index * state_block_bytes, state_block_bytes),
                unpacked_[i]);
            codes_[i] = {unpacked_[i].data()};
        } else {
            const auto state = static_cast<std::size_t>(entry.uniform_status);
            codes_[i] = {columns_of_states<Code>[state].data(), 0};
        }
    }
    // No rule writes the columns and cells beyond the extent, so clear them here.
    if (extent.cells() == static_cast<int>(brick_cells)) return;
    merged_.codes.fill(0);
    merged_.counts.fill(0);
    merged_.weights.fill(0);
}

// Prepares the detection limits. In decibels a limit rises by 20 log10(range), so its Z is
// proportional to the square of the range, arc^2 + (height - altitude)^2. The two terms are
// computed separately: the term of the height here, once for each brick, and the term of the arc
// for each column.
template <class Code>
void BrickMerger<Code>::open_limits(std::span<const BrickLayer> layers,
                                    std::span<const double> levels_m) {
    limits_.resize(layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        // Z at 1 km, times 1e-6 for Z per m^2.
        limits_[i].scale =
            static_cast<Real>(std::pow(10.0, layers[i].limit.at_1km_dbz / 10) * 1e-6);
        for (std::size_t z = 0; z < levels_m.size(); ++z) {
            const double height_m = levels_m[z] - layers[i].site_altitude_m;
            limits_[i].squared_heights_m2[z] = static_cast<Real>(height_m * height_m);
        }
    }
}

// Finds the layers that see something in this column. A site covers little of the domain, so most
// layers see nothing there, and should cost no time.
template <class Code>
void BrickMerger<Code>::find_active(std::size_t column) {
    active_.clear();
    states_ = 0;
    for (std::size_t i = 0; i < codes_.size(); ++i) {
        const Code* codes = codes_[i].column(column);
        const unsigned states = states_in(codes);
        if (states == 0) continue;
        states_ |= states;
        active_.push_back({i, states, codes});
    }
}

// Merges a column by the weighted mean. Three frequent cases need no sums: no layer sees anything,
// only one layer sees anything, or the layers that see something all see no echo.
template <class Code>
template <std::size_t size>
void BrickMerger<Code>::merge_mean(std::span<const BrickLayer> layers, std::size_t column,
                                   int height) {
    find_active(column);
    Code* to = merged_.codes.data() + column * brick_edge;
    std::fill_n(to, height, Code{0});
    if (active_.empty()) return;
    if (active_.size() == 1) {
        std::copy_n(active_[0].codes, height, to);
        return;
    }
    if (states_ == has_no_echo) {
        for (const Active& active : active_) {
            for (int z = 0; z < height; ++z)
                to[z] |= active.codes[z];
        }
        return;
    }
    Sums<size> sums;
    for (const Active& active : active_)
        add(layers[active.layer], active, column, sums);
    finish_mean(sums, to, height);
}

// Adds one layer to the sums of a column. Each state has a loop of its own, which is skipped if the
// column lacks the state. In this loop, cells of other states add 0, so the loop needs no branches.
//
// The codes are copied to wider integers first. The compiler must assume that bytes alias any
// object, so it would not vectorize a loop that writes sums while it reads bytes.
template <class Code>
template <std::size_t size>
void BrickMerger<Code>::add(const BrickLayer& layer, const Active& active, std::size_t column,
                            Sums<size>& sums) const {
    std::array<Word, size> codes;
    for (std::size_t z = 0; z < size; ++z)
        codes[z] = active.codes[z];
    const auto weight = static_cast<Real>(layer.columns->weights[column]);
    // A cell with no echo adds its weight. If a layer has a value in this column, it also adds its
    // detection limit as a value.
    if ((active.states & has_no_echo) != 0) {
        for (std::size_t z = 0; z < size; ++z)
            sums.no_echo[z] += codes[z] == 1 ? weight : 0;
        if (with_limits_ && (states_ & has_value) != 0) {
            std::array<Real, size> limits;
            find_limits(layer, limits_[active.layer], column, limits);
            for (std::size_t z = 0; z < size; ++z)
                sums.sum[z] += codes[z] == 1 ? weight * limits[z] : 0;
        }
    }
    // A cell that is range folded adds only its weight.
    if ((active.states & has_folded) != 0) {
        for (std::size_t z = 0; z < size; ++z)
            sums.folded[z] += codes[z] == 2 ? weight : 0;
    }
    if ((active.states & has_value) == 0) return;
    // A value adds its weight, and its weight times the value. For a mean in Z, the value is Z,
    // from a table. For a mean in dB, it is the code, because values are linear in codes.
    std::array<Real, size> values;
    for (std::size_t z = 0; z < size; ++z)
        values[z] =
            in_z_ ? linear_[static_cast<std::size_t>(codes[z])] : static_cast<Real>(codes[z]);
    for (std::size_t z = 0; z < size; ++z) {
        const Real by = codes[z] >= first_value_code ? weight : 0;
        sums.value[z] += by;
        sums.sum[z] += by * values[z];
    }
}

// Computes a layer's detection limits in a column, as Z if the mean is in Z, else as codes. A code
// is linear in dBZ, and dBZ is linear in log2(Z). So one multiplication turns log2(Z) into a code.
template <class Code>
template <std::size_t size>
void BrickMerger<Code>::find_limits(const BrickLayer& layer, const Limit& limit, std::size_t column,
                                    std::array<Real, size>& limits) const {
    const auto arc2 = static_cast<Real>(layer.columns->squared_arcs_m2[column]);
    const auto least = static_cast<Real>(nearest_range_m2);
    std::array<Real, size> found;
    for (std::size_t z = 0; z < size; ++z)
        found[z] = limit.scale * std::max(arc2 + limit.squared_heights_m2[z], least);
    if (!in_z_) {
        for (std::size_t z = 0; z < size; ++z)
            found[z] = code_base_ + code_per_log2_ * fast_log2(found[z]);
    }
    limits = found;
}

// Decides the state of each cell from its three weights, and turns sums of values into codes.
template <class Code>
template <std::size_t size>
void BrickMerger<Code>::finish_mean(const Sums<size>& sums, Code* to, int height) {
    const auto largest = static_cast<Real>(quantization_.largest_code());
    for (int i = 0; i < height; ++i) {
        const auto z = static_cast<std::size_t>(i);
        const Real value = sums.value[z];
        const Real no_echo = sums.no_echo[z];
        const Real folded = sums.folded[z];
        if (folded > value && folded > no_echo) {
            to[z] = 2;
        } else if (value < no_echo) {
            to[z] = 1;
        } else if (value > 0) {
            Real code = sums.sum[z] / (with_limits_ ? value + no_echo : value);
            if (in_z_) code = code_base_ + code_per_log2_ * fast_log2(code);
            if (code < Real{first_value_code} - Real{0.5}) ++clamped_;
            // The code is at least 3, so truncation rounds down.
            to[z] =
                static_cast<Code>(std::clamp<Real>(code, first_value_code, largest) + Real{0.5});
        }
    }
}

// Merges a column by the maximum. A value ranks above no echo, no echo above range folded, and
// range folded above not seen. Swapping codes 1 and 2 gives a larger code a higher rank, so the
// maximum of all codes decides. Then the two codes are swapped back.
template <class Code>
void BrickMerger<Code>::merge_maximum(std::size_t column, int height) {
    alignas(64) std::array<Code, brick_edge> most{};
    const auto ranked = [](Code code) {
        return static_cast<Code>(code == 1 ? 2 : code == 2 ? 1 : code);
    };
    for (const LayerCodes<Code>& layer : codes_) {
        const Code* codes = layer.column(column);
        for (std::size_t z = 0; z < brick_edge; ++z)
            most[z] = std::max(most[z], ranked(codes[z]));
    }
    Code* to = merged_.codes.data() + column * brick_edge;
    for (int z = 0; z < height; ++z)
        to[z] = ranked(most[static_cast<std::size_t>(z)]);
}

// Merges a column by the nearest site that sees each cell. The layers, nearest first, fill the
// cells that are still empty, until no cell is empty.
template <class Code>
void BrickMerger<Code>::merge_nearest(std::span<const BrickLayer> layers, std::size_t column,
                                      int height) {
    // Sort the layers by distance. Insert them into the order of the previous column, because
    // neighboring columns have almost the same order.
    const auto nearer = [&](std::size_t a, std::size_t b) {
        const float arc_a = layers[a].columns->squared_arcs_m2[column];
        const float arc_b = layers[b].columns->squared_arcs_m2[column];
        return arc_a < arc_b || (arc_a == arc_b && a < b);
    };
    for (std::size_t i = 1; i < order_.size(); ++i) {
        for (std::size_t j = i; j > 0 && nearer(order_[j], order_[j - 1]); --j)
            std::swap(order_[j], order_[j - 1]);
    }
    Code* to = merged_.codes.data() + column * brick_edge;
    std::fill_n(to, height, Code{0});
    for (const std::size_t i : order_) {
        const Code* codes = codes_[i].column(column);
        bool all_seen = true;
        for (int z = 0; z < height; ++z) {
            to[z] = to[z] == 0 ? codes[z] : to[z];
            all_seen &= to[z] != 0;
        }
        if (all_seen) break;
    }
}

template <class Code>
const MergedBrick<Code>& BrickMerger<Code>::merge(std::span<const BrickLayer> layers,
                                                  const BrickExtent& extent,
                                                  std::span<const double> levels_m) {
    open(layers, extent);
    switch (options_.overlap) {
        case Overlap::mean:
        case Overlap::distance_weighted:
            if (with_limits_) open_limits(layers, levels_m);
            for_each_column(extent, [&](std::size_t at) {
                if (extent.z <= few) {
                    merge_mean<few>(layers, at, extent.z);
                } else {
                    merge_mean<brick_edge>(layers, at, extent.z);
                }
            });
            break;
        case Overlap::maximum:
            for_each_column(extent, [&](std::size_t at) { merge_maximum(at, extent.z); });
            break;
        case Overlap::nearest:
            order_.resize(layers.size());
            std::iota(order_.begin(), order_.end(), std::size_t{0});
            for_each_column(extent, [&](std::size_t at) { merge_nearest(layers, at, extent.z); });
            break;
    }
    return merged_;
}

// Counts the sites that see each cell and sums their weights, and stores both as codes. Clamps a
// sum before rounding it, so that it fits into its code.
template <class Code>
const MergedBrick<Code>& BrickMerger<Code>::count(std::span<const BrickLayer> layers,
                                                  const BrickExtent& extent) {
    open(layers, extent);
    for_each_column(extent, [&](std::size_t column) {
        std::array<std::uint16_t, brick_edge> seen{};
        std::array<float, brick_edge> weight{};
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Code* codes = codes_[i].column(column);
            const float by = layers[i].columns->weights[column];
            for (std::size_t z = 0; z < brick_edge; ++z) {
                seen[z] = static_cast<std::uint16_t>(seen[z] + std::uint16_t{codes[z] != 0});
                weight[z] += codes[z] != 0 ? by : 0;
            }
        }
        for (int i = 0; i < extent.z; ++i) {
            const auto z = static_cast<std::size_t>(i);
            const std::size_t cell = column * brick_edge + z;
            constexpr int most = 253;
            constexpr int before_first = first_value_code - 1;
            merged_.counts[cell] = static_cast<std::uint8_t>(
                seen[z] == 0 ? 0 : before_first + std::min<int>(seen[z], most));
            const float steps = std::min(weight[z] / weight_quantization.step, 65000.0F);
            // The number is positive and small. NOLINTNEXTLINE(bugprone-incorrect-roundings)
            const int rounded = static_cast<int>(steps + 0.5F);
            merged_.weights[cell] =
                static_cast<std::uint16_t>(seen[z] == 0 ? 0 : first_value_code + rounded);
        }
    });
    return merged_;
}

template class BrickMerger<std::uint8_t>;
template class BrickMerger<std::uint16_t>;

}  // namespace stormcellar::grid

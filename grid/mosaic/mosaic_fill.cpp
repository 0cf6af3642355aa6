#include "grid/mosaic/mosaic_fill.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "grid/beam/fast_log.h"
#include "grid/mosaic/brick_merge.h"

namespace stormcellar::grid {
namespace {

constexpr float least_power = -99.6578428F;  // 1e-30

// Fills all bricks that have the same bx, in one thread.
template <class Code>
class Slab {
  public:
    Slab(const MosaicWork& work, int bx)
        : work_(work),
          bx_(bx),
          shape_(work.made.cells.view()),
          cells_(work.made.cells),
          merger_(work.options, shape_.quantization) {
        if (work.made.counts) counts_.emplace(*work.made.counts);
        if (work.made.weights) weights_.emplace(*work.made.weights);
    }

    void fill() {
        for (int by = 0; by < shape_.bricks_y; ++by) {
            const std::size_t column =
                shape_.brick_index(bx_, by, 0) / static_cast<std::size_t>(shape_.bricks_z);
            const bool is_changed = work_.changed.empty() || work_.changed[column];
            if (is_changed) {
                merge_column(by);
            } else if (work_.previous != nullptr) {
                copy_column(by);
            }
        }
        cells_.count_clamped(merger_.clamped_count());
    }

    BricksWriter& cells() { return cells_; }
    std::optional<BricksWriter>& counts() { return counts_; }
    std::optional<BricksWriter>& weights() { return weights_; }

  private:
    void copy_column(int by) {
        for (int bz = 0; bz < shape_.bricks_z; ++bz) {
            const std::size_t at = shape_.brick_index(bx_, by, bz);
            cells_.copy(at, work_.previous->cells, at);
            if (counts_) counts_->copy(at, *work_.previous->counts, at);
            if (weights_) weights_->copy(at, *work_.previous->weights, at);
        }
    }

    // Merges all bricks in a column of bricks. Only sites whose windows cover the column matter,
    // and their distances are computed once for all of its bricks.
    void merge_column(int by) {
        here_.clear();
        for (const PlacedSite& site : work_.sites) {
            if (site.covers(bx_, by)) here_.push_back(&site);
        }
        if (here_.empty()) return;
        columns_.resize(std::max(columns_.size(), here_.size()));
        is_measured_.assign(here_.size(), false);
        for (int bz = 0; bz < shape_.bricks_z; ++bz)
            merge_brick(by, bz);
    }

    // Merges one brick. Leaves out sites that see nothing in it. If no site sees anything, the
    // brick stays not seen.
    void merge_brick(int by, int bz) {
        layers_.clear();
        layer_sites_.clear();
        for (std::size_t i = 0; i < here_.size(); ++i) {
            const PlacedSite& site = *here_[i];
            const BrickView& view = site.partial->view;
            const std::size_t brick = site.brick(bx_, by, bz);
            const BrickEntry& entry = view.bricks[brick];
            if (entry.kind == BrickKind::uniform && entry.uniform_status == CellStatus::not_seen) {
                continue;
            }
            layers_.push_back({&view, brick, nullptr, site.limit, site.partial->site.altitude_m});
            layer_sites_.push_back(i);
        }
        if (layers_.empty()) return;
        const std::size_t to = shape_.brick_index(bx_, by, bz);
        const BrickExtent extent = brick_extent(work_.domain, bx_, by, bz);
        if (!merge_by_rule_of_thumb(to, extent)) {
            measure(by);
            const auto levels = std::span(work_.domain.levels_m)
                                    .subspan(static_cast<std::size_t>(bz) * brick_edge,
                                             static_cast<std::size_t>(extent.z));
            cells_.put_codes(to, merger_.merge(layers_, extent, levels).codes.data(), extent);
        }
        if (!counts_ && !weights_) return;
        measure(by);
        const MergedBrick<Code>& counted = merger_.count(layers_, extent);
        if (counts_) counts_->put_codes(to, counted.counts.data(), extent);
        if (weights_) weights_->put_codes(to, counted.weights.data(), extent);
    }

    // Merges a brick if the overlap rule and the weights do not matter. That is so if only one site
    // sees the brick, or if no site has a value or range folded in it. In the second case, a cell
    // is no echo if any site sees no echo there. Returns false for other bricks.
    bool merge_by_rule_of_thumb(std::size_t to, const BrickExtent& extent) {
        if (layers_.size() == 1) {
            cells_.copy(to, *layers_[0].view, layers_[0].brick);
            return true;
        }
        bool any_stored = false;
        bool any_folded = false;
        bool all_no_echo = false;  // one site sees no echo in all cells
        for (const BrickLayer& layer : layers_) {
            const BrickEntry& entry = layer.view->bricks[layer.brick];
            const bool uniform = entry.kind == BrickKind::uniform;
            any_stored |= entry.kind == BrickKind::stored;
            any_folded |= uniform && entry.uniform_status == CellStatus::range_folded;
            all_no_echo |= uniform && entry.uniform_status == CellStatus::no_echo;
        }
        if (any_stored || any_folded) return false;
        // No cell has a value. A state has two bits. Without range folded, the "or" over the sites
        // is no echo if any site sees no echo, else not seen.
        std::array<std::byte, state_block_bytes> any{};
        for (const BrickLayer& layer : layers_) {
            const BrickEntry& entry = layer.view->bricks[layer.brick];
            if (entry.kind != BrickKind::status_only) continue;
            const std::byte* states =
                layer.view->states.data() + entry.status_index * state_block_bytes;
            for (std::size_t i = 0; i < any.size(); ++i)
                any[i] |= states[i];
        }
        constexpr std::byte folded_bits{0xAA};
        for (const std::byte four_cells : any)
            any_folded |= (four_cells & folded_bits) != std::byte{0};
        if (any_folded) return false;
        if (all_no_echo) {
            cells_.put_uniform(to, CellStatus::no_echo);
        } else {
            cells_.put_states(to, any, extent);
        }
        return true;
    }

    // Computes distances and weights of the layers, once for all bricks of the column.
    void measure(int by) {
        const bool by_distance = work_.options.overlap == Overlap::distance_weighted;
        const auto log2_per_m2 = static_cast<float>(
            -std::numbers::log2e / (work_.options.length_m * work_.options.length_m));
        for (std::size_t i = 0; i < layers_.size(); ++i) {
            const std::size_t at = layer_sites_[i];
            LayerColumns& columns = columns_[at];
            layers_[i].columns = &columns;
            if (is_measured_[at]) continue;
            is_measured_[at] = true;
            here_[at]->distance->squared_arcs_m2(bx_, by, columns.squared_arcs_m2);
            if (!by_distance) {
                columns.weights.fill(1);
                continue;
            }
            // Compute the weight exp(-r^2 / L^2) as a power of two, because fast_exp2() vectorizes.
            for (std::size_t c = 0; c < brick_columns; ++c) {
                const float power = columns.squared_arcs_m2[c] * log2_per_m2;
                columns.weights[c] = fast_exp2(std::max(power, least_power));
            }
        }
    }

    const MosaicWork& work_;
    int bx_;
    BrickView shape_;
    BricksWriter cells_;
    std::optional<BricksWriter> counts_, weights_;
    BrickMerger<Code> merger_;
    std::vector<const PlacedSite*> here_;
    std::vector<LayerColumns> columns_;  // for the sites that cover this column of bricks
    std::vector<bool> is_measured_;
    std::vector<BrickLayer> layers_;
    std::vector<std::size_t> layer_sites_;  // indices into columns_
};

// Collects the writers that `pick` selects from each slab, in the order of bricks.
template <class Code, class Pick>
std::vector<BricksWriter> writers_of(std::vector<std::optional<Slab<Code>>>& slabs, Pick pick) {
    std::vector<BricksWriter> writers;
    writers.reserve(slabs.size());
    for (std::optional<Slab<Code>>& slab : slabs)
        writers.push_back(std::move(pick(*slab)));
    return writers;
}

// Calls finish(grid, writers) for each grid of the mosaic. `writers` are the writers of its bricks.
template <class Code, class Finish>
void fill(const MosaicWork& work, Finish finish) {
    const int count = work.made.cells.view().bricks_x;
    std::vector<std::optional<Slab<Code>>> slabs(static_cast<std::size_t>(count));
    for_each_piece(count, work.options.threads, [&](int bx) {
        auto& slab = slabs[static_cast<std::size_t>(bx)];
        slab.emplace(work, bx);
        slab->fill();
    });
    finish(work.made.cells, writers_of<Code>(
                                slabs, [](auto& slab) -> auto& { return slab.cells(); }));
    if (work.made.counts) {
        finish(*work.made.counts, writers_of<Code>(
                                      slabs, [](auto& slab) -> auto& { return *slab.counts(); }));
    }
    if (work.made.weights) {
        finish(*work.made.weights, writers_of<Code>(
                                       slabs, [](auto& slab) -> auto& { return *slab.weights(); }));
    }
}

template <class Finish>
void fill_any(const MosaicWork& work, Finish finish) {
    if (work.made.cells.view().quantization.code_bytes == 1) {
        fill<std::uint8_t>(work, finish);
    } else {
        fill<std::uint16_t>(work, finish);
    }
}

void clear_changed(const std::vector<bool>& changed, BrickGrid& grid) {
    const auto height = static_cast<std::size_t>(grid.view().bricks_z);
    for (std::size_t column = 0; column < changed.size(); ++column) {
        if (!changed[column]) continue;
        for (std::size_t bz = 0; bz < height; ++bz)
            grid.clear(column * height + bz);
    }
}

}  // namespace

void fill_mosaic(const MosaicWork& work) {
    fill_any(work,
             [](BrickGrid& grid, std::vector<BricksWriter> writers) { grid.finish(writers); });
}

void refill_mosaic(const MosaicWork& work) {
    for (auto* grid : {&work.made.counts, &work.made.weights}) {
        if (*grid) clear_changed(work.changed, **grid);
    }
    clear_changed(work.changed, work.made.cells);
    fill_any(work, [](BrickGrid& grid, std::vector<BricksWriter> writers) {
        grid.finish_again(writers);
    });
}

}  // namespace stormcellar::grid

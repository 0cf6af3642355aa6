#include "render/products/hail_field.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

#include "base/parallel.h"
#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::render {
namespace {

using grid::brick_edge;
using grid::BrickEntry;
using grid::BrickKind;
using grid::BrickView;
using grid::CellStatus;
using retrieve::FreezingLevels;
using retrieve::HailLayers;

// Returns the flux of energy of each code up to the largest code of the grid.
std::vector<double> flux_of_codes(const BrickView& view) {
    std::uint16_t largest = 0;
    for (const BrickEntry& entry : view.bricks)
        if (entry.kind == BrickKind::stored) largest = std::max(largest, entry.max_code);
    std::vector<double> flux(std::size_t{largest} + 1, 0.0);
    for (std::size_t code = view.quantization.first_code(); code < flux.size(); ++code)
        flux[code] = retrieve::hail_energy_flux(
            static_cast<double>(view.quantization.value_of(static_cast<std::uint16_t>(code))));
    return flux;
}

// Adds the index of 16 cells of a column. Cells beyond the top of the grid have code 0.
template <class Code>
double index_of_run(const std::byte* codes, const double* flux, std::span<const double> weights_m) {
    std::array<Code, brick_edge> run{};
    std::memcpy(run.data(), codes, sizeof run);
    double sum = 0;
    for (std::size_t z = 0; z < weights_m.size(); ++z)
        sum += weights_m[z] * flux[run[z]];
    return sum;
}

// Computes the index of every column, and reads only the bricks that make hail.
class HailIndexes {
  public:
    HailIndexes(const BrickView& view, const HailLayers& layers)
        : view_(view), layers_(layers), flux_(flux_of_codes(view)) {}

    [[nodiscard]] std::vector<double> compute(int threads) const {
        std::vector<double> indexes(view_.spec->column_count(), 0.0);
        for_each_piece(view_.bricks_y, threads, [&](int by) {
            for (int bx = 0; bx < view_.bricks_x; ++bx)
                for (int bz = 0; bz < view_.bricks_z; ++bz)
                    add_brick(bx, by, bz, indexes);
        });
        return indexes;
    }

    [[nodiscard]] bool makes_hail(CellStatus status, float value, std::size_t level) const {
        return status == CellStatus::value && layers_.weights_m[level] > 0 &&
               retrieve::hail_energy_flux(static_cast<double>(value)) > 0;
    }

  private:
    void add_brick(int bx, int by, int bz, std::vector<double>& indexes) const {
        const std::size_t brick = view_.brick_index(bx, by, bz);
        const BrickEntry& entry = view_.bricks[brick];
        if (entry.kind != BrickKind::stored || !(flux_[entry.max_code] > 0)) return;
        const auto first = static_cast<std::size_t>(bz) * brick_edge;
        const auto weights_m =
            std::span(layers_.weights_m)
                .subspan(first,
                         std::min<std::size_t>(brick_edge, layers_.weights_m.size() - first));
        if (!(weights_m.back() > 0)) return;  // weights grow with height from 0
        const auto width = static_cast<std::size_t>(view_.quantization.code_bytes);
        const std::byte* const codes = view_.codes.data() + brick * grid::brick_cells * width;
        const grid::BrickExtent extent = grid::brick_extent(*view_.spec, bx, by, bz);
        for (int j = 0; j < extent.y; ++j) {
            double* const row = indexes.data() +
                                static_cast<std::size_t>(by * brick_edge + j) *
                                    static_cast<std::size_t>(view_.spec->nx) +
                                static_cast<std::size_t>(bx) * brick_edge;
            for (int i = 0; i < extent.x; ++i) {
                const auto cell = static_cast<std::size_t>((i * brick_edge + j) * brick_edge);
                row[i] +=
                    width == 1
                        ? index_of_run<std::uint8_t>(codes + cell, flux_.data(), weights_m)
                        : index_of_run<std::uint16_t>(codes + 2 * cell, flux_.data(), weights_m);
            }
        }
    }

    const BrickView& view_;
    const HailLayers& layers_;
    std::vector<double> flux_;
};

CellStatus state_without_hail(const ColumnSummary& column) {
    const CellStatus status = ColumnSummary{.lowest_seen = column.lowest_seen,
                                            .max_code = 0,
                                            .has_no_echo = true,
                                            .has_range_folded = column.has_range_folded,
                                            .has_ambiguous = column.has_ambiguous}
                                  .status();
    return column.lowest_seen == ColumnSummary::never ? CellStatus::not_seen : status;
}

// Returns true if the energy next to the hail is unknown, so that the true index may be larger.
bool is_at_least(const HailIndexes& indexes, const std::vector<double>& weights_m,
                 const ColumnCells& cells) {
    const auto is_unknown = [&](std::size_t i) {
        return weights_m[i] > 0 && (cells.status[i] == CellStatus::not_seen ||
                                    cells.status[i] == CellStatus::range_folded);
    };
    const std::size_t last = cells.status.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        if (!indexes.makes_hail(cells.status[i], cells.values[i], i)) continue;
        if (i == last || is_unknown(i + 1) || (i > 0 && is_unknown(i - 1))) return true;
    }
    return false;
}

}  // namespace

Result<FlatField> hail_field(const BrickView& view, float retrieve::Hail::*number,
                             const FreezingLevels& levels, double radar_m,
                             const std::vector<ColumnSummary>& columns, int threads) {
    const auto layers = retrieve::hail_layers(view.spec->levels_m, levels, radar_m);
    if (!layers) return pass_on(layers);
    const HailIndexes hail(view, *layers);
    const std::vector<double> indexes = hail.compute(threads);
    FlatField field(view.spec->nx, view.spec->ny);
    field.at_least.assign(indexes.size(), 0);
    for_each_piece(field.height, threads, [&](int iy) {
        ColumnCells cells;
        for (int ix = 0; ix < field.width; ++ix) {
            const std::size_t place = field.index(ix, iy);
            if (!(indexes[place] > 0)) {
                field.put(place, state_without_hail(columns[place]), 0);
                continue;
            }
            field.put(place, CellStatus::value,
                      retrieve::hail_of_shi(indexes[place], layers->warning_threshold).*number);
            read_column(view, ix, iy, cells);
            field.at_least[place] = is_at_least(hail, layers->weights_m, cells) ? 1 : 0;
        }
    });
    return field;
}

Result<std::optional<LargestHail>> largest_hail(const BrickView& view, const FreezingLevels& levels,
                                                int threads) {
    const auto& levels_m = view.spec->levels_m;
    const auto layers = retrieve::hail_layers(levels_m, levels, 0);
    if (!layers) return pass_on(layers);
    const std::vector<double> indexes = HailIndexes(view, *layers).compute(threads);
    const auto largest = std::ranges::max_element(indexes);
    if (largest == indexes.end() || !(*largest > 0)) return std::nullopt;
    const int place = static_cast<int>(largest - indexes.begin());
    ColumnCells cells;
    read_column(view, place % view.spec->nx, place / view.spec->nx, cells);
    for (std::size_t i = 0; i < cells.values.size(); ++i)
        if (cells.status[i] != CellStatus::value)
            cells.values[i] = std::numeric_limits<float>::quiet_NaN();
    const auto range =
        retrieve::mesh_range(levels_m, cells.values, levels, retrieve::usual_level_error_m);
    if (!range) return pass_on(range);
    return LargestHail{retrieve::hail_of_shi(*largest, layers->warning_threshold).mesh_mm, *range};
}

}  // namespace stormcellar::render

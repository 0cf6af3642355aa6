#include "grid/fill/column_filler.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "grid/fill/mixed_columns.h"
#include "grid/fill/sampled_columns.h"
#include "stormcellar/grid/tile.h"

namespace stormcellar::grid {
namespace {

constexpr std::size_t tiles_a_piece = 16;

// Converts the values of the columns from Z to dB. This step is off by default. The function is
// never inlined, so that it does not enlarge the usual loop.
[[gnu::noinline]] void to_db(const FillWork& work, std::span<const TileColumn> columns) {
    for (const TileColumn& column : columns) {
        const std::span status = status_of(work, column);
        const std::span values = values_of(work, column);
        for (std::size_t level = 0; level < status.size(); ++level) {
            if (status[level] == CellStatus::value) values[level] = 10 * std::log10(values[level]);
        }
    }
}

// Fills tiles, one at a time, in arrays that are allocated once. Finds the columns of a tile that
// are within the range of the radar, plans which sweeps to sample, and fills the columns.
template <class Columns>
class TileFiller {
  public:
    explicit TileFiller(const FillWork& work) : work_(work), filler_(work) {}

    void fill(const Tile& tile) {
        // The tile is beyond every gate, so nothing in it is seen.
        if (!(tile.bounds.least_arc_m < work_.table_end)) return;
        find_columns(tile);
        plan_.make(work_.stack.sweeps, work_.stack.adjacent_to_next, tile.bounds,
                   filler_.reach_over(tile));
        filler_.fill(plan_.sweeps(), columns_);
        if (work_.method.averaging == Averaging::in_z) to_db(work_, columns_);
    }

  private:
    void find_columns(const Tile& tile) {
        columns_.clear();
        const std::size_t height = work_.levels.size();
        for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
            const std::span<const ColumnPlace> row = work_.geometry.row(iy);
            std::size_t cell = work_.grid.spec.index(tile.first_x, iy, 0);
            for (int ix = tile.first_x; ix < tile.end_x; ++ix, cell += height) {
                const ColumnPlace& at = row[static_cast<std::size_t>(ix)];
                if (!(at.arc_m < work_.table_end)) continue;
                columns_.push_back({ix, iy, at.azimuth_deg, ArcTable::place_of(at.arc_m), cell});
            }
        }
    }

    const FillWork& work_;
    TilePlan plan_;
    Columns filler_;
    std::vector<TileColumn> columns_;
};

template <class Columns>
void fill_tiles(const FillWork& work, std::span<const Tile> tiles) {
    TileFiller<Columns> filler(work);
    for (const Tile& tile : tiles)
        filler.fill(tile);
}

using Fill = void (*)(const FillWork&, std::span<const Tile>);

template <bool radial_elevations, bool nearest>
Fill sampled_fill(bool circular) {
    return circular ? fill_tiles<SampledColumns<radial_elevations, nearest, true>>
                    : fill_tiles<SampledColumns<radial_elevations, nearest, false>>;
}

// Chooses the code for the method. So the loops need not test conditions that are equal for all
// tiles.
Fill fill_by(const Method& method, Blending blending) {
    const bool nearest = method.interpolation == Interpolation::nearest;
    const bool sampled = facts_of(method.interpolation).takes_one_gate;
    if (!sampled || method.cell == CellExtent::area) return fill_tiles<MixedColumns>;
    const bool circular = is_circular(blending);
    if (method.radial_elevations) {
        return nearest ? sampled_fill<true, true>(circular) : sampled_fill<true, false>(circular);
    }
    return nearest ? sampled_fill<false, true>(circular) : sampled_fill<false, false>(circular);
}

// Returns the largest number of sweeps on one side of a sweep that may contribute together with it.
int sweeps_by_pattern(const SweepStack& stack) {
    const std::vector<float>& elevations_deg = stack.elevations_deg;
    int most = 1;
    for (std::size_t low = 0; low < elevations_deg.size(); ++low) {
        int within = 1;
        for (std::size_t high = low + 1; high < elevations_deg.size(); ++high) {
            // Radials may be measured up to half a beam above or below their sweep.
            if (elevations_deg[high] - elevations_deg[low] < 2 * stack.beam_width_deg) ++within;
        }
        most = std::max(most, within);
    }
    return most;
}

// Returns how far samples reach beyond a column. The plan of a tile must look as far beyond the
// tile. A method that takes one gate of each sweep does not reach beyond the column.
SampleReach reach_of(const SweepStack& stack, const Method& method) {
    const bool one_gate = facts_of(method.interpolation).takes_one_gate;
    if (one_gate && method.cell == CellExtent::point) return {0, 0, 1, stack.in_order};
    SampleReach reach{0, 2 * stack.gate_spacing_m, 1, stack.in_order};
    for (const PolarSweep& sweep : stack.sweeps) {
        reach.azimuth_deg = std::max(
            reach.azimuth_deg, 2 * std::max(sweep.azimuths().spacing_deg(), stack.beam_width_deg));
    }
    if (facts_of(method.interpolation).is_by_pattern) reach.sweeps = sweeps_by_pattern(stack);
    return reach;
}

}  // namespace

void fill_grid(const SweepStack& stack, const ColumnGeometry& geometry, std::span<const Tile> tiles,
               const Method& method, int threads, Grid& grid) {
    std::vector<float> levels_m;
    for (const double level_m : grid.spec.levels_m)
        levels_m.push_back(static_cast<float>(level_m));
    std::vector<float> heights_m = heights_of_levels(levels_m, method.cell);
    const FillWork work{
        stack,
        geometry,
        method,
        stack.sweeps.front().gates().blending(),
        LevelTable(std::move(levels_m)),
        std::move(heights_m),
        reach_of(stack, method),
        static_cast<float>(static_cast<double>(stack.table_size - 2) * ArcTable::step_m),
        grid};
    const Fill fill = fill_by(method, work.blending);
    const std::size_t pieces = (tiles.size() + tiles_a_piece - 1) / tiles_a_piece;
    for_each_piece(static_cast<int>(pieces), threads, [&](int piece) {
        const std::size_t first = static_cast<std::size_t>(piece) * tiles_a_piece;
        fill(work, tiles.subspan(first, std::min(tiles_a_piece, tiles.size() - first)));
    });
}

}  // namespace stormcellar::grid

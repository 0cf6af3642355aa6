// grid/fill/tile_columns.h -- the columns of a tile with their beams, for all classes that fill
// tiles.
//
// Threads   Plain values. All threads read one `FillWork`; each tile writes its own cells of the
//           grid.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "grid/cells/level_table.h"
#include "grid/fill/column_filler.h"
#include "grid/fill/tile_plan.h"

namespace stormcellar::grid {

// The input and output that all tiles share.
struct FillWork {
    const SweepStack& stack;
    const ColumnGeometry& geometry;
    const Method& method;
    Blending blending;
    LevelTable levels;
    // Heights at which mixed columns are evaluated: one or four for each level.
    std::vector<float> heights_m;
    SampleReach reach;
    float table_end;
    Grid& grid;
};

struct TileColumn {
    int ix = 0;
    int iy = 0;
    float azimuth_deg = 0;
    ArcPlace place;
    std::size_t first_cell = 0;
};

inline std::span<CellStatus> status_of(const FillWork& work, const TileColumn& column) {
    return std::span(work.grid.status).subspan(column.first_cell, work.levels.size());
}
inline std::span<float> values_of(const FillWork& work, const TileColumn& column) {
    return std::span(work.grid.values).subspan(column.first_cell, work.levels.size());
}

// Sorts beams by height. They may be out of order if their radials were measured higher or lower
// than their sweeps. Lost cuts do not move, because a lost cut belongs to a position in the order
// and not to a beam.
template <class Beam>
void put_in_order(std::span<Beam> beams) {
    const auto lower = [](const Beam& a, const Beam& b) { return a.height_m < b.height_m; };
    if (std::is_sorted(beams.begin(), beams.end(), lower)) return;
    std::vector<bool> adjacent;
    for (const Beam& beam : beams)
        adjacent.push_back(beam.adjacent_to_next);
    std::stable_sort(beams.begin(), beams.end(), lower);
    for (std::size_t i = 0; i < beams.size(); ++i)
        beams[i].adjacent_to_next = adjacent[i];
}

}  // namespace stormcellar::grid

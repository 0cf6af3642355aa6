// retrieve/cells/cell_matching.h -- finds the cells of a scan that continue tracks.
//
// A track and a cell may be a pair if the cell is within the gate around the predicted place of the
// track, or if the moved footprint of the track and the footprint of the cell share enough of the
// smaller footprint. The cost of a pair is the distance in gates plus the share of the smaller
// footprint that is not covered. Pairs are taken in order of their cost.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::retrieve {

// A track, and the place where it should be at the time of the scan.
struct ExpectedCell {
    const StormCell* cell = nullptr;  // as it was last seen
    const grid::GridSpec* spec = nullptr;
    grid::GeoPoint place;
    double gate_m = 0;
};

// The least share of a footprint that counts as the same storm.
inline constexpr double least_overlap = 0.3;

// Numbers of columns: the columns of each footprint, and the columns that both have after the first
// footprint was moved.
struct FootprintOverlap {
    double expected = 0, found = 0, common = 0;
    [[nodiscard]] double of_smaller() const;
    [[nodiscard]] double of_expected() const { return expected > 0 ? common / expected : 0; }
    [[nodiscard]] double of_found() const { return found > 0 ? common / found : 0; }
};

struct CellMatches {
    std::vector<std::optional<std::size_t>> found_of;     // by expected cell
    std::vector<std::optional<std::size_t>> expected_of;  // by found cell
    // The overlaps of all pairs that overlap, by expected cell, then by found cell.
    struct Pair {
        std::size_t expected = 0, found = 0;
        FootprintOverlap overlap;
    };
    std::vector<Pair> overlaps;
};

// Footprints of different grids do not overlap, so only distance counts for them.
[[nodiscard]] CellMatches match_cells(std::span<const ExpectedCell> expected, const CellScan& scan);

}  // namespace stormcellar::retrieve

// retrieve/dealias/regions.h -- finds the regions of a sheet, within which velocities are not
// folded against each other, and the votes of neighboring gates about the fold numbers of two
// regions.
//
// The Nyquist interval is cut into three thirds. Adjacent gates whose velocities are in the same
// third belong to one region, because they differ by less than 2/3 of the Nyquist velocity. Where
// gates of different regions meet, they vote for the difference of fold numbers that makes the jump
// between them smallest.
//
// Source   The thirds and the search across gaps follow the region method of Py-ART (Helmus and
//          Collis 2016). The weights of jumps and the runs of gates are our own.
// Threads  Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "retrieve/dealias/fold_graph.h"
#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

// Consecutive gates of a radial in one region.
struct Run {
    std::int32_t radial = 0, begin = 0, end = 0;
    std::int32_t region = 0;
};

struct SheetRegions {
    std::vector<Run> runs;                 // by radial, then by gate
    std::vector<std::size_t> first_run;    // of each radial, and one more
    std::vector<std::int32_t> gate_count;  // of each region
    std::vector<FoldEdge> edges;           // not combined
    // Number of pairs of adjacent gates of different runs, and of pairs whose velocities differ by
    // more than the Nyquist velocity.
    std::int64_t pairs = 0, jumps = 0;
};

[[nodiscard]] SheetRegions find_regions(const VelocitySheet& sheet);

// Cuts each region with a 1 in `is_split` along a grid of tiles, and returns all regions with the
// votes between them. Gates of two pieces of one region vote, too, so that a piece can have
// another fold number than the rest.
[[nodiscard]] SheetRegions split_regions(const VelocitySheet& sheet, const SheetRegions& regions,
                                         const std::vector<std::uint8_t>& is_split);

}  // namespace stormcellar::retrieve

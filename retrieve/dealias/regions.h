// retrieve/dealias/regions.h -- the regions of a sheet, inside which no velocity is folded against
// another, and what neighboring gates say about two regions.
//
// The Nyquist interval is cut into three thirds. Gates side by side whose velocities are in the
// same third are one region: they differ by less than 2/3 of a Nyquist velocity. Where gates of
// different regions meet, the smallest jump between them says which fold numbers would agree.
//
// Source   The thirds and the search across gaps follow the region method of Py-ART (Helmus and
//          Collis 2016). Votes by the size of the jump, and runs of gates, are our own.
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
    // Pairs of adjacent gates, and those whose velocities differ by more than the Nyquist velocity.
    std::int64_t pairs = 0, jumps = 0;
};

[[nodiscard]] SheetRegions find_regions(const VelocitySheet& sheet);

}  // namespace stormcellar::retrieve

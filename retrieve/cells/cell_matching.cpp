#include "retrieve/cells/cell_matching.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

struct PossiblePair {
    double cost = 0;
    std::size_t expected = 0, found = 0;
};

double column_count(std::span<const ColumnRun> runs) {
    double count = 0;
    for (const ColumnRun& run : runs)
        count += run.end_x - run.first_x;
    return count;
}

// Counts the common columns after the first footprint was moved. Both lists are in the order of the
// rows.
double common_columns(std::span<const ColumnRun> moved, std::span<const ColumnRun> still, int by_x,
                      int by_y) {
    double count = 0;
    std::size_t start = 0;
    for (const ColumnRun& run : moved) {
        const int iy = run.iy + by_y;
        while (start < still.size() && still[start].iy < iy)
            ++start;
        for (std::size_t i = start; i < still.size() && still[i].iy == iy; ++i) {
            count += std::max(0, std::min(run.end_x + by_x, still[i].end_x) -
                                     std::max(run.first_x + by_x, still[i].first_x));
        }
    }
    return count;
}

FootprintOverlap overlap_of(const ExpectedCell& expected, const StormCell& found,
                            const grid::GridProjection& projection) {
    const grid::ColumnPoint from = projection.to_column(expected.cell->position);
    const grid::ColumnPoint to = projection.to_column(expected.place);
    const auto by_x = static_cast<int>(std::lround(std::clamp(to.x - from.x, -1e5, 1e5)));
    const auto by_y = static_cast<int>(std::lround(std::clamp(to.y - from.y, -1e5, 1e5)));
    return {column_count(expected.cell->columns), column_count(found.columns),
            common_columns(expected.cell->columns, found.columns, by_x, by_y)};
}

// Takes the cheapest pairs first, each cell once.
void take_pairs(std::vector<PossiblePair>& pairs, CellMatches& matches) {
    std::ranges::stable_sort(pairs, {}, &PossiblePair::cost);
    for (const PossiblePair& pair : pairs) {
        if (matches.found_of[pair.expected] || matches.expected_of[pair.found]) continue;
        matches.found_of[pair.expected] = pair.found;
        matches.expected_of[pair.found] = pair.expected;
    }
}

}  // namespace

double FootprintOverlap::of_smaller() const {
    const double smaller = std::min(expected, found);
    return smaller > 0 ? common / smaller : 0;
}

CellMatches match_cells(std::span<const ExpectedCell> expected, const CellScan& scan) {
    // Cells farther apart than this share no column, because no footprint is larger.
    constexpr double farthest_m = 100'000;
    CellMatches matches;
    matches.found_of.resize(expected.size());
    matches.expected_of.resize(scan.cells.size());
    if (expected.empty() || scan.cells.empty()) return matches;
    const grid::GridProjection projection(scan.spec);
    std::vector<PossiblePair> pairs;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const grid::SiteFrame place(expected[i].place.latitude_deg,
                                    expected[i].place.longitude_deg);
        for (std::size_t j = 0; j < scan.cells.size(); ++j) {
            const StormCell& found = scan.cells[j];
            constexpr double degree_m = 110'000;  // less than a degree of latitude
            const double north_m =
                (found.position.latitude_deg - expected[i].place.latitude_deg) * degree_m;
            if (std::abs(north_m) > farthest_m) continue;
            const double arc_m = place.to_polar(found.position).arc_m;
            if (arc_m > farthest_m) continue;
            FootprintOverlap overlap;
            if (*expected[i].spec == scan.spec)
                overlap = overlap_of(expected[i], found, projection);
            if (overlap.common > 0) matches.overlaps.push_back({i, j, overlap});
            if (arc_m > expected[i].gate_m && overlap.of_smaller() < least_overlap) continue;
            pairs.push_back({arc_m / expected[i].gate_m + 1 - overlap.of_smaller(), i, j});
        }
    }
    take_pairs(pairs, matches);
    return matches;
}

}  // namespace stormcellar::retrieve

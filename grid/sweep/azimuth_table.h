// grid/sweep/azimuth_table.h -- tells which radials of a sweep see an azimuth.
//
// The table finds the nearest radial, the two radials on either side of an azimuth, or all radials
// within a reach. If two neighboring radials are more than one and a half spacings apart, there is
// a gap: each of the two reaches half a spacing into the gap, and no radial sees the rest of it.
// Pairs and neighborhoods do not extend across gaps. If radials have the same azimuth, the radial
// that is later in the given order counts. Radials may be in any order and number, and may wrap
// around north.
//
// A lookup starts from a table of quarter degrees and then searches along sorted boundaries,
// usually for a step or two. So it is exact.
//
// Units     Degrees, clockwise from north.
// Threads   Immutable.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stormcellar::grid {

class AzimuthTable {
  public:
    static constexpr int none = -1;

    // There must be one azimuth in [0, 360) for each radial. The spacing must be above 0.
    AzimuthTable(std::span<const float> azimuths_deg, double spacing_deg);

    // Returns the position of the nearest radial in the constructor's list. Returns none if no
    // radial sees the azimuth. The azimuth must be in [0, 360).
    [[nodiscard]] int find(float azimuth_deg) const { return radials_[sector_at(azimuth_deg)]; }

    // The nearest radial, and its neighbor on the other side of the azimuth. `other_weight` is the
    // share of the neighbor, in [0, 1/2], if values are linear in between. `other` is none if a gap
    // is on that side.
    struct Bracket {
        int nearest = none;
        int other = none;
        float other_weight = 0;
    };
    [[nodiscard]] Bracket bracket(float azimuth_deg) const;

    // Calls visit(position, offset_deg) for the radial nearest to the azimuth, and for each radial
    // within `reach_deg` that no gap separates from the azimuth. The offset is positive clockwise.
    // Calls nothing if no radial sees the azimuth.
    template <class Visit>
    void visit(float azimuth_deg, float reach_deg, Visit visit) const;

    // Calls visit() for each radial within `reach_deg`, even if a gap is in between. A reach of 180
    // visits all radials.
    template <class Visit>
    void visit_all(float azimuth_deg, float reach_deg, Visit visit) const;

    // Returns the share of azimuths that some radial sees, in the range from `from_deg` clockwise
    // over `width_deg`. The width is at most 360.
    [[nodiscard]] double seen_share(double from_deg, double width_deg) const;

    // Calls visit(position) for every radial that sees some azimuth from `from_deg` to `to_deg`
    // (from <= to < from + 360, from in [0, 360)). Calls it with `none` for each gap. Stops when
    // visit returns false.
    template <class Visit>
    void visit_between(float from_deg, float to_deg, Visit visit) const;

    [[nodiscard]] bool has_gaps() const { return has_gaps_; }
    [[nodiscard]] float spacing_deg() const { return spacing_deg_; }

  private:
    static constexpr float bins_a_degree = 4;
    static constexpr std::size_t bin_count = 1440;

    struct Entry {
        float azimuth_deg;
        int radial;
        bool gap_after;  // a gap follows, clockwise
    };

    [[nodiscard]] std::size_t sector_at(float azimuth_deg) const {
        std::size_t at = first_of_bin_[static_cast<std::size_t>(azimuth_deg * bins_a_degree)];
        while (azimuth_deg >= ends_deg_[at])
            ++at;
        return at;
    }
    // Returns the angle from one azimuth to another, within +-180 degrees.
    [[nodiscard]] static float turn_deg(float from_deg, float to_deg) {
        const float turn = to_deg - from_deg;
        return turn > 180 ? turn - 360 : turn < -180 ? turn + 360 : turn;
    }
    void sort(std::span<const float> azimuths_deg);
    void make_sectors();
    void add_sector(double end_deg, int entry);

    float spacing_deg_;
    bool has_gaps_ = false;
    std::vector<Entry> entries_;  // by azimuth
    // The sectors from 0 to 360 degrees. Each has its end, the radial that sees it, and the entry
    // of that radial.
    std::vector<float> ends_deg_;
    std::vector<int> radials_;
    std::vector<int> sector_entries_;
    std::array<std::uint32_t, bin_count + 1> first_of_bin_{};
};

template <class Visit>
void AzimuthTable::visit(float azimuth_deg, float reach_deg, Visit visit) const {
    const int nearest = sector_entries_[sector_at(azimuth_deg)];
    if (nearest == none) return;
    const auto count = entries_.size();
    const auto start = static_cast<std::size_t>(nearest);
    visit(entries_[start].radial, turn_deg(azimuth_deg, entries_[start].azimuth_deg));
    std::size_t at = start;
    for (std::size_t step = 1; step < count && !entries_[at].gap_after; ++step) {
        at = at + 1 == count ? 0 : at + 1;
        const float offset_deg = turn_deg(azimuth_deg, entries_[at].azimuth_deg);
        if (!(offset_deg >= 0 && offset_deg < reach_deg)) break;
        visit(entries_[at].radial, offset_deg);
    }
    at = start;
    for (std::size_t step = 1; step < count; ++step) {
        at = at == 0 ? count - 1 : at - 1;
        if (entries_[at].gap_after) break;
        const float offset_deg = turn_deg(azimuth_deg, entries_[at].azimuth_deg);
        if (!(offset_deg <= 0 && offset_deg > -reach_deg)) break;
        visit(entries_[at].radial, offset_deg);
    }
}

template <class Visit>
void AzimuthTable::visit_all(float azimuth_deg, float reach_deg, Visit visit) const {
    const auto count = entries_.size();
    float from_deg = azimuth_deg - reach_deg;
    if (from_deg < 0) from_deg += 360;
    const auto from =
        std::lower_bound(entries_.begin(), entries_.end(), from_deg,
                         [](const Entry& entry, float deg) { return entry.azimuth_deg < deg; });
    auto at = static_cast<std::size_t>(from - entries_.begin());
    for (std::size_t step = 0; step < count; ++step, ++at) {
        if (at == count) at = 0;
        const float offset_deg = turn_deg(azimuth_deg, entries_[at].azimuth_deg);
        if (reach_deg < 180 && offset_deg > reach_deg) return;
        // Rounding may find such a radial.
        if (reach_deg < 180 && offset_deg < -reach_deg) continue;
        visit(entries_[at].radial, offset_deg);
    }
}

template <class Visit>
void AzimuthTable::visit_between(float from_deg, float to_deg, Visit visit) const {
    std::size_t at = sector_at(from_deg);
    float turned_deg = 0;  // 360 once north was passed
    while (true) {
        if (!visit(radials_[at])) return;
        if (ends_deg_[at] + turned_deg > to_deg) return;
        if (++at == ends_deg_.size()) {
            at = 0;
            turned_deg += 360;
            if (turned_deg > 360) return;
        }
    }
}

}  // namespace stormcellar::grid

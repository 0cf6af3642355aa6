#include "grid/sweep/azimuth_table.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::grid {
namespace {

constexpr double gap_spacings = 1.5;

}  // namespace

void AzimuthTable::sort(std::span<const float> azimuths_deg) {
    for (std::size_t i = 0; i < azimuths_deg.size(); ++i)
        entries_.push_back({azimuths_deg[i], static_cast<int>(i), false});
    // If azimuths are equal, sort later radials first, because unique() keeps the first of equal
    // entries.
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.azimuth_deg != b.azimuth_deg ? a.azimuth_deg < b.azimuth_deg : a.radial > b.radial;
    });
    const auto last =
        std::unique(entries_.begin(), entries_.end(),
                    [](const Entry& a, const Entry& b) { return a.azimuth_deg == b.azimuth_deg; });
    entries_.erase(last, entries_.end());
}

void AzimuthTable::add_sector(double end_deg, int entry) {
    const auto end = static_cast<float>(std::clamp(end_deg, 0.0, 360.0));
    if (end <= (ends_deg_.empty() ? 0.0F : ends_deg_.back())) return;
    ends_deg_.push_back(end);
    sector_entries_.push_back(entry);
    radials_.push_back(entry == none ? none : entries_[static_cast<std::size_t>(entry)].radial);
}

// Makes the sectors, from the last radial before north once around to the first radial after north.
// The sectors of neighboring radials meet half way, unless there is a gap between the radials.
void AzimuthTable::make_sectors() {
    const std::size_t count = entries_.size();
    if (count == 0) {
        add_sector(360, none);
        return;
    }
    const auto spacing_deg = static_cast<double>(spacing_deg_);
    std::size_t before = count - 1;
    double before_deg = static_cast<double>(entries_[before].azimuth_deg) - 360;
    for (std::size_t i = 0; i <= count; ++i) {
        const std::size_t here = i % count;
        const double here_deg =
            static_cast<double>(entries_[here].azimuth_deg) + (i == count ? 360 : 0);
        const double step_deg = here_deg - before_deg;
        if (step_deg <= gap_spacings * spacing_deg) {
            add_sector(before_deg + step_deg / 2, static_cast<int>(before));
        } else {
            entries_[before].gap_after = has_gaps_ = true;
            add_sector(before_deg + spacing_deg / 2, static_cast<int>(before));
            add_sector(here_deg - spacing_deg / 2, none);
        }
        before = here;
        before_deg = here_deg;
    }
    add_sector(360, static_cast<int>(before));
}

// Sectors are narrow and many, so the table notes the first sector in each quarter degree. find()
// then starts there.
AzimuthTable::AzimuthTable(std::span<const float> azimuths_deg, double spacing_deg)
    : spacing_deg_(static_cast<float>(spacing_deg)) {
    sort(azimuths_deg);
    make_sectors();
    std::uint32_t sector = 0;
    for (std::size_t bin = 0; bin <= bin_count; ++bin) {
        const float start_deg = static_cast<float>(bin) / bins_a_degree;
        while (sector + 1 < ends_deg_.size() && ends_deg_[sector] <= start_deg)
            ++sector;
        first_of_bin_[bin] = sector;
    }
}

AzimuthTable::Bracket AzimuthTable::bracket(float azimuth_deg) const {
    const int found = sector_entries_[sector_at(azimuth_deg)];
    if (found == none) return {};
    const auto at = static_cast<std::size_t>(found);
    const std::size_t count = entries_.size();
    const Entry& nearest = entries_[at];
    const float offset_deg = turn_deg(azimuth_deg, nearest.azimuth_deg);
    const bool is_behind = offset_deg <= 0;
    const std::size_t beside =
        is_behind ? (at + 1 == count ? 0 : at + 1) : (at == 0 ? count - 1 : at - 1);
    const bool gap = is_behind ? nearest.gap_after : entries_[beside].gap_after;
    if (gap || beside == at) return {nearest.radial, none, 0};
    const float near_deg = std::abs(offset_deg);
    const float far_deg = std::abs(turn_deg(azimuth_deg, entries_[beside].azimuth_deg));
    const float weight = near_deg / (near_deg + far_deg);
    return {nearest.radial, entries_[beside].radial, std::min(weight, 0.5F)};
}

double AzimuthTable::seen_share(double from_deg, double width_deg) const {
    if (!(width_deg > 0)) return 1;
    const double start_deg = from_deg - 360 * std::floor(from_deg / 360);
    const double end_deg = start_deg + width_deg;
    double seen_deg = 0;
    double sector_start_deg = 0;
    for (std::size_t at = 0; at < ends_deg_.size(); ++at) {
        const auto sector_end_deg = static_cast<double>(ends_deg_[at]);
        if (radials_[at] != none) {
            for (const double turn : {0.0, 360.0}) {
                const double low = std::max(start_deg, sector_start_deg + turn);
                const double high = std::min(end_deg, sector_end_deg + turn);
                seen_deg += std::max(0.0, high - low);
            }
        }
        sector_start_deg = sector_end_deg;
    }
    return seen_deg / width_deg;
}

}  // namespace stormcellar::grid

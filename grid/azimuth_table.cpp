#include "grid/azimuth_table.h"

#include <algorithm>

namespace stormcellar::grid {
namespace {

constexpr double gap_spacings = 1.5;

struct Entry {
    double azimuth_deg;
    int radial;
};

std::vector<Entry> sorted_entries(std::span<const float> azimuths_deg) {
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < azimuths_deg.size(); ++i)
        entries.push_back({static_cast<double>(azimuths_deg[i]), static_cast<int>(i)});
    // Of equal azimuths the later radial comes first and is the one that unique() keeps.
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.azimuth_deg != b.azimuth_deg ? a.azimuth_deg < b.azimuth_deg : a.radial > b.radial;
    });
    const auto last =
        std::unique(entries.begin(), entries.end(),
                    [](const Entry& a, const Entry& b) { return a.azimuth_deg == b.azimuth_deg; });
    entries.erase(last, entries.end());
    return entries;
}

}  // namespace

void AzimuthTable::add_sector(double end_deg, int radial) {
    const auto end = static_cast<float>(std::clamp(end_deg, 0.0, 360.0));
    if (end <= (ends_deg_.empty() ? 0.0F : ends_deg_.back())) return;
    ends_deg_.push_back(end);
    radials_.push_back(radial);
}

AzimuthTable::AzimuthTable(std::span<const float> azimuths_deg, double spacing_deg) {
    const std::vector<Entry> entries = sorted_entries(azimuths_deg);
    if (entries.empty()) {
        add_sector(360, none);
    } else {
        // Once round, from the last radial before north to the first one after it.
        Entry before = entries.back();
        before.azimuth_deg -= 360;
        for (std::size_t i = 0; i <= entries.size(); ++i) {
            Entry here = entries[i % entries.size()];
            if (i == entries.size()) here.azimuth_deg += 360;
            const double step_deg = here.azimuth_deg - before.azimuth_deg;
            if (step_deg <= gap_spacings * spacing_deg) {
                add_sector(before.azimuth_deg + step_deg / 2, before.radial);
            } else {
                add_sector(before.azimuth_deg + spacing_deg / 2, before.radial);
                add_sector(here.azimuth_deg - spacing_deg / 2, none);
            }
            before = here;
        }
        add_sector(360, before.radial);
    }

    std::uint32_t sector = 0;
    for (std::size_t bin = 0; bin <= bin_count; ++bin) {
        const float start_deg = static_cast<float>(bin) / bins_a_degree;
        while (sector + 1 < ends_deg_.size() && ends_deg_[sector] <= start_deg)
            ++sector;
        first_of_bin_[bin] = sector;
    }
}

}  // namespace stormcellar::grid

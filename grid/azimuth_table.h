// grid/azimuth_table.h -- which radial of a sweep sees an azimuth.
//
// The nearest one. Where neighbouring radials are more than one and a half spacings apart there is
// a gap: each then reaches half a spacing into it and the rest is seen by none. Of radials at the
// same azimuth the later one (in the order given) counts. Any order, any number, wrap included.
// Exact: a lookup is a table of quarter degrees and a step or two along sorted boundaries.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stormcellar::grid {

class AzimuthTable {
  public:
    static constexpr int none = -1;

    // Azimuths in [0, 360), one a radial; a spacing above 0.
    AzimuthTable(std::span<const float> azimuths_deg, double spacing_deg);

    // The position in the list given, or none. The azimuth must be in [0, 360).
    [[nodiscard]] int find(float azimuth_deg) const {
        std::size_t at = first_of_bin_[static_cast<std::size_t>(azimuth_deg * bins_a_degree)];
        while (azimuth_deg >= ends_deg_[at])
            ++at;
        return radials_[at];
    }

  private:
    static constexpr float bins_a_degree = 4;
    static constexpr std::size_t bin_count = 1440;

    void add_sector(double end_deg, int radial);

    // Sectors side by side from 0 to 360 degrees: where each ends, and who sees it.
    std::vector<float> ends_deg_;
    std::vector<int> radials_;
    std::array<std::uint32_t, bin_count + 1> first_of_bin_{};
};

}  // namespace stormcellar::grid

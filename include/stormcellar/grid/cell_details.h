// stormcellar/grid/cell_details.h -- what else can be known of a cell beside its value, on demand.
//
// Of each cell that is not `not_seen`, from the nearest gates (nearest radial, nearest in range) of
// the sweeps that it is made of: the two that bracket it, with weights linear in height; outside of
// them, beside a lost cut and for Interpolation::nearest the nearer one alone. Those of them that
// see the place count, whatever else the method mixes in:
//   age            s; mean of the times of their nearest radials, by weight, minus the frame time
//                  (GridderOptions::frame_time): negative before it, positive after it. Not known
//                  where one of these radials is undated, or the volume and no frame time is given
//   height_offset  m; height of the cell minus that of the centre of the nearest of their beams
//   over
//                  the same place: positive above the beam
//   distance       m; in space from the cell's centre to the nearest of the centres of their gates:
//                  hypot of the difference in height and of that in the plane about the site in
//                  which arc and azimuth are polar coordinates
//   weight         1; the share of the weight of all that the method mixes that was seen, 1 - u of
//                  the status rule (grid/sweep/mixture.h): 1/2 to 1
// Cells with an extent are described at their centre (weight: as a whole). Where several gates are
// mixed, or the cell has an extent, none of the nearest gates may see a cell that others see: then
// only its weight is known.
// Accuracy (tests/grid/cell_details_test.cpp, within 470 km): height_offset 0.5 m and distance 0.5
// m of the beam model; age and weight of the cell's linear weights are those of a cell up to 0.5 m
// higher or lower, beside 2 ms and 1e-5.
// Threads: plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "stormcellar/grid/chosen.h"

namespace stormcellar::grid {

// Whether any were asked for.
using ChosenDetails = Chosen<false, false>;

enum class Detail : std::uint8_t { age, height_offset, distance, weight };
inline constexpr std::array all_details = {Detail::age, Detail::height_offset, Detail::distance,
                                           Detail::weight};

// "age", "height_offset", "distance", "weight".
[[nodiscard]] std::string_view detail_name(Detail detail);
[[nodiscard]] std::optional<Detail> detail_from_name(std::string_view name);

class DetailSet {
  public:
    void add(Detail detail) { bits_ |= bit_of(detail); }
    [[nodiscard]] bool has(Detail detail) const { return (bits_ & bit_of(detail)) != 0; }
    [[nodiscard]] bool any() const { return ChosenDetails::can_be(true) && bits_ != 0; }

    [[nodiscard]] static std::uint8_t bit_of(Detail detail) {
        return static_cast<std::uint8_t>(1U << static_cast<unsigned>(detail));
    }

  private:
    std::uint8_t bits_ = 0;
};

// Of all cells of a grid, index by GridSpec::index().
class CellDetails {
  public:
    CellDetails() = default;
    // Room for those of the set; nothing is known yet.
    CellDetails(DetailSet set, std::size_t cells);

    [[nodiscard]] DetailSet set() const { return set_; }
    // None where it is not known, or was not asked for.
    [[nodiscard]] std::optional<float> at(Detail detail, std::size_t cell) const;
    // Cells that there is room for; 0 when nothing was asked for.
    [[nodiscard]] std::size_t size() const { return known_.size(); }
    // The detail must be of the set. Different cells may be put by different threads.
    void put(Detail detail, std::size_t cell, float value);

  private:
    DetailSet set_;
    std::array<std::vector<float>, all_details.size()> values_;  // empty where not asked for
    std::vector<std::uint8_t> known_;                            // a bit a detail
};

}  // namespace stormcellar::grid

// stormcellar/grid/cell_details.h -- details of a cell besides its value, on demand.
//
// A detail can be known only for a cell that is not `not_seen`. Details describe the nearest gates
// (nearest radial, nearest in range) of the sweeps that make up the cell. These are the two sweeps
// that bracket the cell, with weights linear in height. Above and below all sweeps, beside a lost
// cut and for Interpolation::nearest, only the nearer sweep counts. Only gates that see the place
// count, even if the method mixes in more gates:
//   age            s; the weighted mean of the times of the radials of these gates, minus the frame
//                  time (GridderOptions::frame_time); negative before the frame time. The age is
//                  unknown if one of these radials has no time, or if the volume has no time and no
//                  frame time is given.
//   height_offset  m; the height of the cell minus the height of the center of the nearest of these
//                  beams over the same place: positive above the beam
//   distance       m; the distance in space from the center of the cell to the nearest center of
//                  these gates: hypot of the difference in height and the distance in the plane
//                  about the site in which arc and azimuth are polar coordinates
//   weight         1; the share of the mixed weight that was seen, 1 - u of the status rule
//                  (grid/sweep/mixture.h): 1/2 to 1
// If cells are areas (CellExtent::area), the weight describes the whole cell and the other details
// describe its center. If cells are areas or the method mixes several gates, a cell may be seen
// although none of its nearest gates sees it. Then only its weight is known.
//
// Units     Seconds and meters, as above.
// Threads   Plain values; see CellDetails::put() for writing.
// Errors    None; an unknown detail is none.
// Accuracy  Within 470 km, enforced by tests/grid/cell_details_test.cpp: height_offset and distance
//           are within 0.5 m of the beam model. With linear weights, age and weight equal the age
//           and weight of a cell up to 0.5 m higher or lower, within 2 ms and 1e-5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "stormcellar/grid/chosen.h"

namespace stormcellar::grid {

// True if the caller asks for any details.
using ChosenDetails = Chosen<false, false>;

enum class Detail : std::uint8_t { age, height_offset, distance, weight };
inline constexpr std::array all_details = {Detail::age, Detail::height_offset, Detail::distance,
                                           Detail::weight};

// Returns "age", "height_offset", "distance" or "weight".
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

// The details of all cells of a grid; the index is GridSpec::index().
class CellDetails {
  public:
    CellDetails() = default;
    // Makes room for the details of the set, for every cell. All begin as unknown.
    CellDetails(DetailSet set, std::size_t cells);

    [[nodiscard]] DetailSet set() const { return set_; }
    // Returns a detail; none if it is unknown or not in the set.
    [[nodiscard]] std::optional<float> at(Detail detail, std::size_t cell) const;
    // Returns the number of cells with room for details; 0 if the set is empty.
    [[nodiscard]] std::size_t size() const { return known_.size(); }
    // Sets a detail, which must be in the set. Threads may call this at once for different cells.
    void put(Detail detail, std::size_t cell, float value);

  private:
    DetailSet set_;
    std::array<std::vector<float>, all_details.size()> values_;  // empty for details not asked for
    std::vector<std::uint8_t> known_;                            // one bit for each detail
};

}  // namespace stormcellar::grid

// grid/cells/value_tally.h -- counts the values that many grids have at each place.
//
// A place is a cell or a column. The value of a column is the greatest value of its cells
// (grid/cells/grid_tally.h). All sums are integers. So if the tallies of the parts of a period are
// added, in any order, the sum is the tally of the whole period, bit for bit.
//
// Units     Reflectivity in dBZ.
// Range     Up to 2^32 grids.
// Threads   Plain data; one thread at a time changes it.
// Accuracy  A quantile is the middle of a bin of 5 dBZ, so it is off by at most 2.5 dBZ, except in
//           the first and the last bin. Means and maxima are exact for the codes. In a sum of Z,
//           each value is rounded to 0.001 mm^6/m^3.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

class ValueTally {
  public:
    // Bin 0 counts values below -30 dBZ; the last bin counts values of 75 dBZ and more.
    static constexpr std::size_t bins = 23;
    static constexpr double first_edge_dbz = -30, bin_width_db = 5;
    [[nodiscard]] static double edge_dbz(std::size_t bin);  // the lower edge; bin 0 has none

    ValueTally(std::size_t places, Quantization quantization);

    // Counts the place in one more grid that has seen it. A code below quantization.first_code()
    // means that the place has no value.
    void count(std::size_t place, std::uint16_t code) {
        ++seen_[place];
        if (code >= quantization_.first_code()) count_value(place, code);
    }
    // Adds a tally, which must have the number of places and the quantization of this tally.
    void add(const ValueTally& more);

    [[nodiscard]] std::size_t places() const { return seen_.size(); }
    [[nodiscard]] std::uint32_t seen(std::size_t place) const { return seen_[place]; }
    [[nodiscard]] std::uint32_t with_value(std::size_t place) const;
    [[nodiscard]] std::uint32_t in_bin(std::size_t place, std::size_t bin) const {
        return in_bins_[place * bins + bin];
    }
    [[nodiscard]] std::uint32_t from_bin_on(std::size_t place, std::size_t bin) const;
    // These functions cover only the grids in which the place has a value.
    [[nodiscard]] double greatest_dbz(std::size_t place) const;
    [[nodiscard]] double mean_dbz(std::size_t place) const;       // mean of the values in dBZ
    [[nodiscard]] double mean_z_as_dbz(std::size_t place) const;  // mean of Z, converted to dBZ
    // Returns the middle of a bin: the lowest bin for which at least this share of the values is in
    // it or below it.
    [[nodiscard]] double quantile_dbz(std::size_t place, double share) const;

    // append_to() appends bytes_of() bytes, which hold all counts and sums. take_from() reads such
    // bytes from the front of `bytes` and removes them. Errors: corrupt if no grid can have one of
    // the greatest values.
    void append_to(std::vector<std::byte>& bytes) const;
    [[nodiscard]] Status take_from(std::span<const std::byte>& bytes);
    [[nodiscard]] static std::uint64_t bytes_of(std::size_t places);

  private:
    void count_value(std::size_t place, std::uint16_t code);

    Quantization quantization_;
    std::vector<std::uint32_t> seen_, in_bins_;
    std::vector<std::uint16_t> greatest_;        // code of the greatest value; 0: no value
    std::vector<std::uint64_t> codes_, powers_;  // sums of codes, and of Z in thousandths
    std::vector<std::uint8_t> bin_of_;           // the bin of each code
    std::vector<std::uint64_t> power_of_;        // the Z of each code, in thousandths
};

template <class Number>
void append_numbers(const std::vector<Number>& numbers, std::vector<std::byte>& bytes) {
    const auto more = std::as_bytes(std::span(numbers));
    bytes.insert(bytes.end(), more.begin(), more.end());
}
// Fills `numbers` from the front of `bytes`, which must be long enough. Removes what it has read.
template <class Number>
void take_numbers(std::span<const std::byte>& bytes, std::vector<Number>& numbers) {
    const auto target = std::as_writable_bytes(std::span(numbers));
    std::copy_n(bytes.begin(), target.size(), target.begin());
    bytes = bytes.subspan(target.size());
}
template <class Number>
void add_numbers(const std::vector<Number>& more, std::vector<Number>& sums) {
    std::transform(more.begin(), more.end(), sums.begin(), sums.begin(), std::plus<>{});
}

}  // namespace stormcellar::grid

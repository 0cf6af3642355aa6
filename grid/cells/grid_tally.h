// grid/cells/column_tally.h -- counts what many grids of one shape show in each column, for
// statistics over months and years.
//
// All sums are integers of codes and counts, so tallies of parts of a time, added in any order, are
// to the bit the tally of the whole. What was not seen is counted apart from what had no echo, so
// that a blind region is not taken for a dry one.
//
// Units     Reflectivity in dBZ; levels are those of the grids.
// Range     2^32 grids.
// Threads   Plain data; one thread at a time changes it.
// Errors    bad_argument for grids of another shape or quantization.
// Accuracy  Quantiles are the middles of bins of 5 dBZ: within 2.5 dBZ. Means and maxima are those
//           of the codes. A sum of Z counts each value to 0.001 mm^6/m^3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {

class ColumnTally {
  public:
    // Bin 0 has what is below -30 dBZ, the last one what is 75 dBZ or more.
    static constexpr std::size_t bins = 23;
    static constexpr double first_edge_dbz = -30, bin_width_db = 5;
    static constexpr double echo_top_dbz = 18.5;
    [[nodiscard]] static double edge_dbz(std::size_t bin);  // lower edge of bin 1 and above

    ColumnTally(GridSpec spec, Quantization quantization);

    // Counts one grid: of each column whether any cell was seen, its greatest value, and the
    // highest level with 18.5 dBZ.
    [[nodiscard]] Status add(const BrickView& grid);
    [[nodiscard]] Status add(const ColumnTally& more);

    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    [[nodiscard]] const Quantization& quantization() const { return quantization_; }
    [[nodiscard]] std::uint64_t grids() const { return grids_; }
    // Of a column, which is iy * nx + ix:
    [[nodiscard]] std::uint32_t seen(std::size_t column) const { return seen_[column]; }
    [[nodiscard]] std::uint32_t with_value(std::size_t column) const;
    [[nodiscard]] std::uint32_t in_bin(std::size_t column, std::size_t bin) const {
        return in_bins_[column * bins + bin];
    }
    [[nodiscard]] std::uint32_t from_bin_on(std::size_t column, std::size_t bin) const;
    [[nodiscard]] std::uint32_t tops_from(std::size_t column, std::size_t level) const;
    // These are of columns with a value.
    [[nodiscard]] double greatest_dbz(std::size_t column) const;
    [[nodiscard]] double mean_dbz(std::size_t column) const;       // of the values in dBZ
    [[nodiscard]] double mean_z_as_dbz(std::size_t column) const;  // of the values as Z
    // The middle of the bin in which the share of the values is reached.
    [[nodiscard]] double quantile_dbz(std::size_t column, double share) const;

    // Returns all counts and sums as bytes, and takes them back. Errors: truncated.
    [[nodiscard]] std::vector<std::byte> to_bytes() const;
    [[nodiscard]] Status from_bytes(std::span<const std::byte> bytes);
    [[nodiscard]] static std::uint64_t bytes_of(const GridSpec& spec);

  private:
    void count_column(std::size_t column, bool is_seen, std::uint16_t greatest, int top);
    [[nodiscard]] Status check_shape(const BrickView& grid) const;

    GridSpec spec_;
    Quantization quantization_;
    std::uint64_t grids_ = 0;
    std::vector<std::uint32_t> seen_, in_bins_, tops_;
    std::vector<std::uint16_t> greatest_;        // codes; 0: no value
    std::vector<std::uint64_t> codes_, powers_;  // sums of codes, and of Z in thousandths
    std::vector<std::uint8_t> bin_of_;           // by code
    std::vector<std::uint64_t> power_of_;        // by code
    std::uint16_t top_code_ = 0;                 // the first that counts for the echo top
};

}  // namespace stormcellar::grid

// grid/cells/grid_tally.h -- counts the values of many grids of one shape, for statistics over
// months and years. Counts the greatest value and the echo top of each column and, on request, the
// values of each cell.
//
// Places that were not seen are counted separately from places without echo, so that a blind region
// does not look dry. If the tallies of the parts of a period are added, in any order, the sum is
// the tally of the whole period, bit for bit (grid/cells/value_tally.h, which states units and
// accuracy).
//
// Range     Up to 2^32 grids.
// Threads   Plain data; one thread at a time changes it.
// Errors    bad_argument for grids of another shape or quantization.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "grid/cells/value_tally.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {

enum class Tallied { columns, columns_and_cells };

class GridTally {
  public:
    static constexpr double echo_top_dbz = 18.5;

    GridTally(GridSpec spec, Quantization quantization, Tallied tallied = Tallied::columns);

    // Counts one grid. For each column, counts whether any of its cells was seen, its greatest
    // value, and the highest level with at least 18.5 dBZ.
    [[nodiscard]] Status add(const BrickView& grid);
    [[nodiscard]] Status add(const GridTally& more);

    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    [[nodiscard]] const Quantization& quantization() const { return quantization_; }
    [[nodiscard]] std::uint64_t grids() const { return grids_; }
    // Returns the tally of the greatest values of columns. The index of a column is iy * nx + ix.
    [[nodiscard]] const ValueTally& columns() const { return columns_; }
    // Returns the tally of the values of cells, or none if cells are not counted. The index of a
    // cell is GridSpec::index().
    [[nodiscard]] const std::optional<ValueTally>& cells() const { return cells_; }
    [[nodiscard]] std::uint32_t tops_from(std::size_t column, std::size_t level) const;

    // to_bytes() writes all counts and sums into bytes() bytes. from_bytes() reads them back.
    // Errors: truncated, corrupt.
    [[nodiscard]] std::vector<std::byte> to_bytes() const;
    [[nodiscard]] Status from_bytes(std::span<const std::byte> bytes);
    [[nodiscard]] std::uint64_t bytes() const { return bytes_of(spec_, tallied()); }
    [[nodiscard]] static std::uint64_t bytes_of(const GridSpec& spec, Tallied tallied);

  private:
    void count_column(const BrickView& grid, int ix, int iy);
    void count_cells(const BrickView& grid, int ix, int iy);
    [[nodiscard]] Status check_shape(const BrickView& grid) const;
    [[nodiscard]] Tallied tallied() const {
        return cells_ ? Tallied::columns_and_cells : Tallied::columns;
    }

    GridSpec spec_;
    Quantization quantization_;
    std::uint64_t grids_ = 0;
    ValueTally columns_;
    std::optional<ValueTally> cells_;
    std::vector<std::uint32_t> tops_;  // index: column, then level
    std::uint16_t top_code_ = 0;       // the smallest code that counts for the echo top
};

}  // namespace stormcellar::grid

#include "grid/cells/grid_tally.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

GridTally::GridTally(GridSpec spec, Quantization quantization, Tallied tallied)
    : spec_(std::move(spec)),
      quantization_(quantization),
      columns_(spec_.column_count(), quantization),
      tops_(spec_.cell_count()) {
    if (tallied == Tallied::columns_and_cells) cells_.emplace(spec_.cell_count(), quantization);
    top_code_ = std::numeric_limits<std::uint16_t>::max();
    for (std::uint16_t code = quantization_.largest_code(); code >= quantization_.first_code();
         --code) {
        if (quantization_.value_of(code) >= echo_top_dbz) top_code_ = code;
    }
}

Status GridTally::check_shape(const BrickView& grid) const {
    if (grid.bricks_x == bricks_along(spec_.nx) && grid.bricks_y == bricks_along(spec_.ny) &&
        grid.bricks_z == bricks_along(spec_.nz()) && grid.quantization == quantization_) {
        return {};
    }
    return fail(ErrorCode::bad_argument, "the grid has another shape than those counted before");
}

Status GridTally::add(const BrickView& grid) {
    if (Status fits = check_shape(grid); !fits) return fits;
    ++grids_;
    for (int iy = 0; iy < spec_.ny; ++iy) {
        for (int ix = 0; ix < spec_.nx; ++ix) {
            count_column(grid, ix, iy);
            if (cells_) count_cells(grid, ix, iy);
        }
    }
    return {};
}

// Counts a column. If the column has no stored brick, no cell of it has a value. Then the search
// ends at the first cell that was seen.
void GridTally::count_column(const BrickView& grid, int ix, int iy) {
    const std::size_t base = grid.offset_x(ix) + grid.offset_y(iy);
    std::uint16_t greatest = 0;
    int top = -1;
    for (int iz = 0; iz < spec_.nz(); ++iz) {
        const std::uint16_t code = grid.code_at(base + grid.offset_z(iz));
        greatest = std::max(greatest, code);
        if (code >= top_code_) top = iz;
    }
    bool is_seen = greatest > 0;
    for (int iz = 0; iz < spec_.nz() && !is_seen; ++iz)
        is_seen = grid.status(ix, iy, iz) != CellStatus::not_seen;
    if (!is_seen) return;
    const std::size_t column = spec_.index(ix, iy, 0) / spec_.levels_m.size();
    columns_.count(column, greatest);
    if (top >= 0) ++tops_[column * spec_.levels_m.size() + static_cast<std::size_t>(top)];
}

void GridTally::count_cells(const BrickView& grid, int ix, int iy) {
    const std::size_t base = grid.offset_x(ix) + grid.offset_y(iy);
    for (int iz = 0; iz < spec_.nz(); ++iz) {
        const std::uint16_t code = grid.code_at(base + grid.offset_z(iz));
        const bool is_seen = code > 0 || grid.status(ix, iy, iz) != CellStatus::not_seen;
        if (is_seen) cells_->count(spec_.index(ix, iy, iz), code);
    }
}

Status GridTally::add(const GridTally& more) {
    if (more.spec_ != spec_ || more.quantization_ != quantization_ || more.tallied() != tallied()) {
        return fail(ErrorCode::bad_argument, "the counts are of grids of another shape");
    }
    grids_ += more.grids_;
    columns_.add(more.columns_);
    if (cells_) cells_->add(*more.cells_);
    add_numbers(more.tops_, tops_);
    return {};
}

std::uint32_t GridTally::tops_from(std::size_t column, std::size_t level) const {
    std::uint32_t count = 0;
    for (; level < spec_.levels_m.size(); ++level)
        count += tops_[column * spec_.levels_m.size() + level];
    return count;
}

std::vector<std::byte> GridTally::to_bytes() const {
    std::vector<std::byte> bytes;
    bytes.reserve(this->bytes());
    append_numbers(std::vector{grids_}, bytes);
    append_numbers(tops_, bytes);
    columns_.append_to(bytes);
    if (cells_) cells_->append_to(bytes);
    return bytes;
}

Status GridTally::from_bytes(std::span<const std::byte> bytes) {
    if (bytes.size() != this->bytes()) {
        return fail(ErrorCode::truncated, "has {} bytes of counts instead of {}", bytes.size(),
                    this->bytes());
    }
    std::vector<std::uint64_t> grids(1);
    take_numbers(bytes, grids);
    grids_ = grids[0];
    take_numbers(bytes, tops_);
    if (Status taken = columns_.take_from(bytes); !taken) return taken;
    return cells_ ? cells_->take_from(bytes) : Status{};
}

std::uint64_t GridTally::bytes_of(const GridSpec& spec, Tallied tallied) {
    const std::uint64_t of_cells =
        tallied == Tallied::columns_and_cells ? ValueTally::bytes_of(spec.cell_count()) : 0;
    return sizeof(std::uint64_t) + ValueTally::bytes_of(spec.column_count()) +
           spec.cell_count() * sizeof(std::uint32_t) + of_cells;
}

}  // namespace stormcellar::grid

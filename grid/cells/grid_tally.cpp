#include "grid/cells/column_tally.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {
namespace {

std::uint8_t bin_of_value(double dbz) {
    const double bin =
        std::floor((dbz - ColumnTally::first_edge_dbz) / ColumnTally::bin_width_db) + 1;
    return static_cast<std::uint8_t>(
        std::clamp(bin, 0.0, static_cast<double>(ColumnTally::bins - 1)));
}

template <class Number>
void append(const std::vector<Number>& numbers, std::vector<std::byte>& bytes) {
    const auto more = std::as_bytes(std::span(numbers));
    bytes.insert(bytes.end(), more.begin(), more.end());
}

template <class Number>
void take(std::span<const std::byte>& bytes, std::vector<Number>& numbers) {
    const std::size_t size = numbers.size() * sizeof(Number);
    std::memcpy(numbers.data(), bytes.data(), size);
    bytes = bytes.subspan(size);
}

template <class Number>
void add_each(const std::vector<Number>& more, std::vector<Number>& sums) {
    std::ranges::transform(more, sums, sums.begin(), std::plus<>{});
}

}  // namespace

double ColumnTally::edge_dbz(std::size_t bin) {
    return first_edge_dbz + bin_width_db * (static_cast<double>(bin) - 1);
}

ColumnTally::ColumnTally(GridSpec spec, Quantization quantization)
    : spec_(std::move(spec)),
      quantization_(quantization),
      seen_(spec_.column_count()),
      in_bins_(spec_.column_count() * bins),
      tops_(spec_.cell_count()),
      greatest_(spec_.column_count()),
      codes_(spec_.column_count()),
      powers_(spec_.column_count()) {
    // What follows from a code alone is looked up.
    const std::size_t codes = std::size_t{quantization_.largest_code()} + 1;
    bin_of_.resize(codes);
    power_of_.resize(codes);
    top_code_ = std::numeric_limits<std::uint16_t>::max();
    for (std::size_t code = codes; code-- > first_value_code;) {
        const double dbz = quantization_.value_of(static_cast<std::uint16_t>(code));
        bin_of_[code] = bin_of_value(dbz);
        power_of_[code] =
            static_cast<std::uint64_t>(std::llround(1000 * std::pow(10, std::min(dbz, 95.5) / 10)));
        if (dbz >= echo_top_dbz) top_code_ = static_cast<std::uint16_t>(code);
    }
}

Status ColumnTally::check_shape(const BrickView& grid) const {
    if (grid.bricks_x == bricks_along(spec_.nx) && grid.bricks_y == bricks_along(spec_.ny) &&
        grid.bricks_z == bricks_along(spec_.nz()) && grid.quantization == quantization_) {
        return {};
    }
    return fail(ErrorCode::bad_argument, "the grid has another shape than those counted before");
}

// A column without a stored brick has no value, so its states are asked only until one is seen.
Status ColumnTally::add(const BrickView& grid) {
    if (Status fits = check_shape(grid); !fits) return fits;
    ++grids_;
    std::size_t column = 0;
    for (int iy = 0; iy < spec_.ny; ++iy) {
        for (int ix = 0; ix < spec_.nx; ++ix, ++column) {
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
            count_column(column, is_seen, greatest, top);
        }
    }
    return {};
}

void ColumnTally::count_column(std::size_t column, bool is_seen, std::uint16_t greatest, int top) {
    if (!is_seen) return;
    ++seen_[column];
    if (greatest < first_value_code) return;
    ++in_bins_[column * bins + bin_of_[greatest]];
    greatest_[column] = std::max(greatest_[column], greatest);
    codes_[column] += greatest;
    powers_[column] += power_of_[greatest];
    if (top >= 0) ++tops_[column * spec_.levels_m.size() + static_cast<std::size_t>(top)];
}

Status ColumnTally::add(const ColumnTally& more) {
    if (more.spec_ != spec_ || more.quantization_ != quantization_) {
        return fail(ErrorCode::bad_argument, "the counts are of grids of another shape");
    }
    grids_ += more.grids_;
    add_each(more.seen_, seen_);
    add_each(more.in_bins_, in_bins_);
    add_each(more.tops_, tops_);
    add_each(more.codes_, codes_);
    add_each(more.powers_, powers_);
    std::ranges::transform(more.greatest_, greatest_, greatest_.begin(),
                           [](auto a, auto b) { return std::max(a, b); });
    return {};
}

std::uint32_t ColumnTally::from_bin_on(std::size_t column, std::size_t bin) const {
    std::uint32_t count = 0;
    for (; bin < bins; ++bin)
        count += in_bin(column, bin);
    return count;
}

std::uint32_t ColumnTally::with_value(std::size_t column) const {
    return from_bin_on(column, 0);
}

std::uint32_t ColumnTally::tops_from(std::size_t column, std::size_t level) const {
    std::uint32_t count = 0;
    for (; level < spec_.levels_m.size(); ++level)
        count += tops_[column * spec_.levels_m.size() + level];
    return count;
}

double ColumnTally::greatest_dbz(std::size_t column) const {
    return quantization_.value_of(greatest_[column]);
}

double ColumnTally::mean_dbz(std::size_t column) const {
    const double code = static_cast<double>(codes_[column]) / with_value(column);
    return double{quantization_.first_value} +
           double{quantization_.step} * (code - first_value_code);
}

double ColumnTally::mean_z_as_dbz(std::size_t column) const {
    return 10 * std::log10(static_cast<double>(powers_[column]) / 1000 / with_value(column));
}

double ColumnTally::quantile_dbz(std::size_t column, double share) const {
    const double wanted = share * with_value(column);
    std::uint32_t count = 0;
    std::size_t bin = 0;
    for (; bin + 1 < bins; ++bin) {
        count += in_bin(column, bin);
        if (count >= wanted) break;
    }
    return edge_dbz(bin) + bin_width_db / 2;
}

std::vector<std::byte> ColumnTally::to_bytes() const {
    std::vector<std::byte> bytes;
    bytes.reserve(bytes_of(spec_));
    append(std::vector{grids_}, bytes);
    append(codes_, bytes);
    append(powers_, bytes);
    append(seen_, bytes);
    append(in_bins_, bytes);
    append(tops_, bytes);
    append(greatest_, bytes);
    return bytes;
}

Status ColumnTally::from_bytes(std::span<const std::byte> bytes) {
    if (bytes.size() != bytes_of(spec_)) {
        return fail(ErrorCode::truncated, "has {} bytes of counts instead of {}", bytes.size(),
                    bytes_of(spec_));
    }
    std::vector<std::uint64_t> grids(1);
    take(bytes, grids);
    grids_ = grids[0];
    take(bytes, codes_);
    take(bytes, powers_);
    take(bytes, seen_);
    take(bytes, in_bins_);
    take(bytes, tops_);
    take(bytes, greatest_);
    const auto is_code = [&](std::uint16_t code) { return code <= quantization_.largest_code(); };
    if (!std::ranges::all_of(greatest_, is_code)) {
        return fail(ErrorCode::corrupt, "has a greatest value that no grid can have");
    }
    return {};
}

std::uint64_t ColumnTally::bytes_of(const GridSpec& spec) {
    constexpr std::uint64_t a_column = 2 * 8 + 4 + 4 * bins + 2;
    return 8 + spec.column_count() * a_column + spec.cell_count() * 4;
}

}  // namespace stormcellar::grid

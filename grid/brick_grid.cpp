#include "grid/brick_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/checksum.h"

namespace stormcellar::grid {
namespace {

constexpr int status_kinds = 4;
using BrickCodes = std::array<std::uint16_t, brick_cells>;

// The nearest code; a value beyond the ends of the code range takes the end and is counted.
std::uint16_t code_of(float value, const Quantization& quantization, std::uint64_t& clamped) {
    const double steps =
        (static_cast<double>(value) - static_cast<double>(quantization.first_value)) /
        static_cast<double>(quantization.step);
    const double code = std::nearbyint(steps) + first_value_code;
    if (code >= first_value_code && code <= quantization.largest_code()) {
        return static_cast<std::uint16_t>(code);
    }
    ++clamped;
    return code > first_value_code ? quantization.largest_code() : first_value_code;
}

// One brick of cells as codes; cells beyond the grid's edge stay 0, which is not seen.
class BrickReader {
  public:
    BrickReader(const Grid& grid, const Quantization& quantization)
        : grid_(grid), quantization_(quantization) {}

    void read(int bx, int by, int bz) {
        codes_.fill(0);
        const GridSpec& spec = grid_.spec;
        const int end_x = std::min(brick_edge, spec.nx - bx * brick_edge);
        const int end_y = std::min(brick_edge, spec.ny - by * brick_edge);
        const int end_z = std::min(brick_edge, spec.nz() - bz * brick_edge);
        for (int x = 0; x < end_x; ++x) {
            for (int y = 0; y < end_y; ++y) {
                const std::size_t from =
                    spec.index(bx * brick_edge + x, by * brick_edge + y, bz * brick_edge);
                std::uint16_t* to = codes_.data() + brick_edge * (brick_edge * x + y);
                for (int z = 0; z < end_z; ++z)
                    to[z] = cell_code(from + z);
            }
        }
    }
    [[nodiscard]] const BrickCodes& codes() const { return codes_; }
    [[nodiscard]] std::uint64_t clamped_count() const { return clamped_; }

  private:
    std::uint16_t cell_code(std::size_t cell) {
        const CellStatus status = grid_.status[cell];
        if (status != CellStatus::value) return static_cast<std::uint16_t>(status);
        return code_of(grid_.values[cell], quantization_, clamped_);
    }

    const Grid& grid_;
    const Quantization& quantization_;
    BrickCodes codes_{};
    std::uint64_t clamped_ = 0;
};

// What a brick is, but for where its bytes go.
BrickEntry summarize(const BrickCodes& codes) {
    BrickEntry entry;
    std::array<int, status_kinds> counts{};
    std::uint16_t smallest = 65535;
    std::uint16_t largest = 0;
    for (const std::uint16_t code : codes) {
        ++counts[std::min(code, first_value_code)];
        if (code < first_value_code) continue;
        smallest = std::min(smallest, code);
        largest = std::max(largest, code);
    }
    if (counts[first_value_code] > 0) {
        entry.kind = BrickKind::stored;
        entry.value_count = static_cast<std::uint16_t>(counts[first_value_code]);
        entry.min_code = smallest;
        entry.max_code = largest;
        return entry;
    }
    for (std::size_t status = 0; status < first_value_code; ++status) {
        if (counts[status] != static_cast<int>(brick_cells)) continue;
        entry.uniform_status = static_cast<CellStatus>(status);
        return entry;
    }
    entry.kind = BrickKind::status_only;
    return entry;
}

std::span<std::byte> write_codes(const BrickCodes& codes, int code_bytes, std::byte* place) {
    if (code_bytes == 1) {
        std::transform(codes.begin(), codes.end(), place,
                       [](std::uint16_t code) { return static_cast<std::byte>(code); });
    } else {
        std::memcpy(place, codes.data(), sizeof codes);
    }
    return {place, brick_cells * static_cast<std::size_t>(code_bytes)};
}

std::array<std::byte, brick_cells / 4> pack_states(const BrickCodes& codes) {
    std::array<std::byte, brick_cells / 4> packed{};
    for (std::size_t cell = 0; cell < brick_cells; ++cell)
        packed[cell / 4] |= static_cast<std::byte>(codes[cell] << (2 * (cell % 4)));
    return packed;
}

}  // namespace

BrickGrid BrickGrid::from(const Grid& grid, const Quantization& quantization) {
    BrickGrid made;
    made.spec_ = grid.spec;
    made.quantization_ = quantization;
    const BrickView shape = made.view();
    made.bricks_.resize(static_cast<std::size_t>(shape.bricks_x) * shape.bricks_y * shape.bricks_z);
    const std::size_t place_bytes = brick_cells * static_cast<std::size_t>(quantization.code_bytes);
    made.codes_.resize(made.bricks_.size() * place_bytes);

    BrickReader reader(grid, made.quantization_);
    std::size_t index = 0;
    for (int bx = 0; bx < shape.bricks_x; ++bx) {
        for (int by = 0; by < shape.bricks_y; ++by) {
            for (int bz = 0; bz < shape.bricks_z; ++bz, ++index) {
                reader.read(bx, by, bz);
                BrickEntry entry = summarize(reader.codes());
                if (entry.kind == BrickKind::stored) {
                    entry.checksum = xxh3_64(write_codes(reader.codes(), quantization.code_bytes,
                                                         made.codes_.data() + index * place_bytes));
                } else if (entry.kind == BrickKind::status_only) {
                    const auto packed = pack_states(reader.codes());
                    entry.status_index =
                        static_cast<std::uint32_t>(made.states_.size() / packed.size());
                    entry.checksum = xxh3_64(packed);
                    made.states_.insert(made.states_.end(), packed.begin(), packed.end());
                }
                made.bricks_[index] = entry;
            }
        }
    }
    made.clamped_count_ = reader.clamped_count();
    return made;
}

BrickView BrickGrid::view() const {
    BrickView view;
    view.spec = &spec_;
    view.quantization = quantization_;
    view.bricks_x = bricks_along(spec_.nx);
    view.bricks_y = bricks_along(spec_.ny);
    view.bricks_z = bricks_along(spec_.nz());
    view.codes = codes_;
    view.bricks = bricks_;
    view.states = states_;
    return view;
}

Grid to_dense(const BrickView& view) {
    Grid grid;
    grid.spec = *view.spec;
    grid.values.resize(grid.spec.cell_count());
    grid.status.resize(grid.spec.cell_count());
    for (int iy = 0; iy < grid.spec.ny; ++iy) {
        for (int ix = 0; ix < grid.spec.nx; ++ix) {
            for (int iz = 0; iz < grid.spec.nz(); ++iz) {
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                grid.status[cell] = view.status(ix, iy, iz);
                if (grid.status[cell] == CellStatus::value) {
                    grid.values[cell] = view.value(ix, iy, iz);
                }
            }
        }
    }
    return grid;
}

}  // namespace stormcellar::grid

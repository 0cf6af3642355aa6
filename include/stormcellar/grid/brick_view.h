// stormcellar/grid/brick_view.h -- a read-only view of a quantized grid in bricks, in memory or in
// a mapped file.
//
// Every brick of 16x16x16 cells has a fixed address, so the address of a cell is the sum of three
// numbers, one for each axis, and needs no lookup. Bricks that hold no value are absent: their
// bytes read as zeros (a hole in a sparse file, or untouched memory), and their entry gives their
// status. A brick of 8-bit codes is one page of 4,096 bytes.
//
// Inside a brick z runs fastest, then y, then x. Bricks are in the same order.
// Code 0 means not seen, 1 no echo and 2 range folded; from 3 on, value = first_value + step *
// (code - 3). In derived moments, code 3 means ambiguous, and values begin at code 4. Code 3 is
// stored and counted like a value, so that the format of files is the same.
//
// Threads   A view is plain data over bytes that another object owns; any thread may read it.
// Errors    None: indices must be within the grid.
// Accuracy  A value is within step / 2 of the value that was quantized.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

inline constexpr int brick_edge = 16;
inline constexpr std::size_t brick_cells = 4096;
inline constexpr std::size_t state_block_bytes = brick_cells / 4;  // the states of a brick's cells
inline constexpr std::uint16_t first_value_code = 3;  // from here on, bricks store codes

struct Quantization {
    int code_bytes = 1;          // 1 or 2
    float first_value = -32;     // value of code 3
    float step = 0.5F;           // the rounding error is at most step / 2
    bool has_ambiguous = false;  // code 3 means ambiguous

    // Returns the first code that means a value.
    [[nodiscard]] std::uint16_t first_code() const {
        return has_ambiguous ? first_value_code + 1 : first_value_code;
    }
    [[nodiscard]] CellStatus status_of(std::uint16_t code) const {
        if (code < first_value_code) return static_cast<CellStatus>(code);
        return code < first_code() ? CellStatus::ambiguous : CellStatus::value;
    }

    [[nodiscard]] float value_of(std::uint16_t code) const {
        return first_value + step * static_cast<float>(code - first_value_code);
    }
    [[nodiscard]] std::uint16_t largest_code() const { return code_bytes == 1 ? 255 : 65535; }
    bool operator==(const Quantization&) const = default;
};

// Returns steps no coarser than the radar's own codes, such as 0.5 dBZ from -32 for REF.
[[nodiscard]] Quantization default_quantization(level2::Moment moment);

enum class BrickKind : std::uint8_t {
    uniform = 0,      // absent: every cell has uniform_status
    status_only = 1,  // absent, but the states differ: 1,024 bytes of 2-bit states
    stored = 2,       // codes are stored
};

struct BrickEntry {
    BrickKind kind = BrickKind::uniform;
    CellStatus uniform_status = CellStatus::not_seen;
    std::uint16_t value_count = 0;  // cells with a value, at most 4,096
    std::uint16_t min_code = 0;     // over the cells with a value
    std::uint16_t max_code = 0;
    std::uint32_t status_index = 0;  // status_only: the number of its 1,024-byte block
    std::uint32_t packed_bytes = 0;  // stored in a file with packed codes: their length in the file
    std::uint64_t checksum = 0;      // XXH3 of the brick's codes or of its states
};
static_assert(sizeof(BrickEntry) == 24);

class SweepLookup;  // stormcellar/grid/sweep_lookup.h

// The view of one sweep (a ppi) has no bricks. The spec of such a view has one level, the plane
// about the radar on which the sweep is drawn, and `sweep` finds the gate at a place.
struct BrickView {
    const GridSpec* spec = nullptr;
    Quantization quantization;
    int bricks_x = 0, bricks_y = 0, bricks_z = 0;
    std::span<const std::byte> codes;  // bricks_x * bricks_y * bricks_z * 4,096 * code_bytes bytes
    std::span<const BrickEntry> bricks;
    std::span<const std::byte> states;  // blocks of 1,024 bytes, 4 cells a byte, low bits first
    const SweepLookup* sweep = nullptr;

    [[nodiscard]] std::size_t brick_index(int bx, int by, int bz) const {
        return (static_cast<std::size_t>(bx) * static_cast<std::size_t>(bricks_y) +
                static_cast<std::size_t>(by)) *
                   static_cast<std::size_t>(bricks_z) +
               static_cast<std::size_t>(bz);
    }
    // These return the offset of a cell along each axis, in codes. The address of a cell is their
    // sum.
    [[nodiscard]] std::size_t offset_x(int ix) const {
        return brick_index(ix / brick_edge, 0, 0) * brick_cells +
               static_cast<std::size_t>(ix % brick_edge) * brick_edge * brick_edge;
    }
    [[nodiscard]] std::size_t offset_y(int iy) const {
        return brick_index(0, iy / brick_edge, 0) * brick_cells +
               static_cast<std::size_t>(iy % brick_edge) * brick_edge;
    }
    [[nodiscard]] std::size_t offset_z(int iz) const {
        return brick_index(0, 0, iz / brick_edge) * brick_cells +
               static_cast<std::size_t>(iz % brick_edge);
    }
    // Returns the stored code at an offset; always 0 inside absent bricks.
    [[nodiscard]] std::uint16_t code_at(std::size_t offset) const;
    // Returns the status of any cell, in absent bricks too, but slowly. The cell must exist.
    [[nodiscard]] CellStatus status(int ix, int iy, int iz) const;
    [[nodiscard]] float value(int ix, int iy, int iz) const;  // the cell's status must be value
};

[[nodiscard]] constexpr int bricks_along(int cells) {
    return (cells + brick_edge - 1) / brick_edge;
}

}  // namespace stormcellar::grid

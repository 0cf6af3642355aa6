// cache/format.h -- the bytes of a grid file, as docs/cache-format.md specifies them.
//
// All numbers are little-endian, like the supported machines, so a brick of a mapped file needs no
// conversion. Assertions check every offset that the document specifies.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::cache::format {

static_assert(std::endian::native == std::endian::little, "grid files are mapped as they stand");

// The first bytes of a file. They distinguish the file from text. A file has other first bytes if
// it was sent over a 7-bit line, or if its line ends were converted.
inline constexpr std::array<unsigned char, 8> magic = {0x89, 'S', 'C', 'G', '\r', '\n', 0x1A, '\n'};
inline constexpr std::uint32_t byte_order_mark = 0x01020304;
inline constexpr std::uint32_t version = 2;
// The oldest version that is read. The versions from this one to `version` differ only in the
// meaning of their records.
inline constexpr std::uint32_t oldest_version = 1;
inline constexpr std::uint64_t page_size = 4096;

// Limits that bound the memory of a reader.
inline constexpr std::uint64_t max_description_bytes = std::uint64_t{1} << 20;
inline constexpr std::uint64_t max_bricks = std::uint64_t{1} << 22;
inline constexpr std::uint64_t max_metadata_bytes = std::uint64_t{1} << 29;
inline constexpr std::uint64_t status_block_bytes = 1024;

// Bits of required_features.
inline constexpr std::uint32_t feature_window = 1;  // offset_x_cells or offset_y_cells is not 0
// Bricks of codes are packed one by one and follow each other without gaps.
inline constexpr std::uint32_t packed_codes = 2;
inline constexpr std::uint32_t known_features = feature_window | packed_codes;

// The header at offset 0; the rest of the first page is zero.
struct FileHeader {
    std::array<unsigned char, 8> magic{};
    std::uint32_t byte_order = 0;
    std::uint32_t version = 0;
    std::uint32_t required_features = 0;  // bits that a reader must know
    std::uint32_t header_size = 0;        // 4096
    std::uint64_t file_size = 0;
    std::uint64_t checksum = 0;  // XXH3 of all bytes before the codes, with this field as zero
    std::uint64_t levels_offset = 0;
    std::uint64_t description_offset = 0;
    std::uint64_t description_size = 0;
    std::uint64_t table_offset = 0;
    std::uint64_t states_offset = 0;
    std::uint64_t states_size = 0;
    std::uint64_t codes_offset = 0;
    std::uint64_t codes_size = 0;
    std::uint32_t projection = 0;
    std::uint32_t nx = 0, ny = 0, nz = 0;
    double center_latitude_deg = 0;
    double center_longitude_deg = 0;
    double spacing = 0;  // meters; degrees for latitude_longitude
    std::uint32_t moment = 0;
    std::uint32_t code_bytes = 0;
    float first_value = 0;
    float step = 0;
    std::uint32_t brick_edge = 0;
    std::uint32_t bricks_x = 0, bricks_y = 0, bricks_z = 0;
    std::int64_t time_ms = 0;  // since 1970-01-01T00:00Z
    std::int64_t start_time_ms = 0;
    std::int64_t end_time_ms = 0;
    double offset_x_cells = 0;  // position of the grid, if it is a window of a larger grid
    double offset_y_cells = 0;
};
static_assert(std::is_trivially_copyable_v<FileHeader>);
static_assert(sizeof(FileHeader) == 216);
static_assert(offsetof(FileHeader, magic) == 0);
static_assert(offsetof(FileHeader, byte_order) == 8);
static_assert(offsetof(FileHeader, version) == 12);
static_assert(offsetof(FileHeader, required_features) == 16);
static_assert(offsetof(FileHeader, header_size) == 20);
static_assert(offsetof(FileHeader, file_size) == 24);
static_assert(offsetof(FileHeader, checksum) == 32);
static_assert(offsetof(FileHeader, levels_offset) == 40);
static_assert(offsetof(FileHeader, description_offset) == 48);
static_assert(offsetof(FileHeader, description_size) == 56);
static_assert(offsetof(FileHeader, table_offset) == 64);
static_assert(offsetof(FileHeader, states_offset) == 72);
static_assert(offsetof(FileHeader, states_size) == 80);
static_assert(offsetof(FileHeader, codes_offset) == 88);
static_assert(offsetof(FileHeader, codes_size) == 96);
static_assert(offsetof(FileHeader, projection) == 104);
static_assert(offsetof(FileHeader, nx) == 108);
static_assert(offsetof(FileHeader, ny) == 112);
static_assert(offsetof(FileHeader, nz) == 116);
static_assert(offsetof(FileHeader, center_latitude_deg) == 120);
static_assert(offsetof(FileHeader, center_longitude_deg) == 128);
static_assert(offsetof(FileHeader, spacing) == 136);
static_assert(offsetof(FileHeader, moment) == 144);
static_assert(offsetof(FileHeader, code_bytes) == 148);
static_assert(offsetof(FileHeader, first_value) == 152);
static_assert(offsetof(FileHeader, step) == 156);
static_assert(offsetof(FileHeader, brick_edge) == 160);
static_assert(offsetof(FileHeader, bricks_x) == 164);
static_assert(offsetof(FileHeader, bricks_y) == 168);
static_assert(offsetof(FileHeader, bricks_z) == 172);
static_assert(offsetof(FileHeader, time_ms) == 176);
static_assert(offsetof(FileHeader, start_time_ms) == 184);
static_assert(offsetof(FileHeader, end_time_ms) == 192);
static_assert(offsetof(FileHeader, offset_x_cells) == 200);
static_assert(offsetof(FileHeader, offset_y_cells) == 208);

// An entry of the brick table has the same bytes on disk and in memory.
using grid::BrickEntry;
static_assert(std::is_trivially_copyable_v<BrickEntry> && sizeof(BrickEntry) == 24);
static_assert(offsetof(BrickEntry, kind) == 0);
static_assert(offsetof(BrickEntry, uniform_status) == 1);
static_assert(offsetof(BrickEntry, value_count) == 2);
static_assert(offsetof(BrickEntry, min_code) == 4);
static_assert(offsetof(BrickEntry, max_code) == 6);
static_assert(offsetof(BrickEntry, status_index) == 8);
static_assert(offsetof(BrickEntry, packed_bytes) == 12);
static_assert(offsetof(BrickEntry, checksum) == 16);
static_assert(static_cast<int>(grid::BrickKind::uniform) == 0);
static_assert(static_cast<int>(grid::BrickKind::status_only) == 1);
static_assert(static_cast<int>(grid::BrickKind::stored) == 2);
static_assert(static_cast<int>(grid::CellStatus::not_seen) == 0);
static_assert(static_cast<int>(grid::CellStatus::no_echo) == 1);
static_assert(static_cast<int>(grid::CellStatus::range_folded) == 2);
static_assert(static_cast<int>(grid::CellStatus::value) == 3);
static_assert(static_cast<int>(grid::Projection::azimuthal_equidistant) == 0);
static_assert(static_cast<int>(grid::Projection::latitude_longitude) == 1);
static_assert(static_cast<int>(grid::Projection::lambert_conformal) == 2);
static_assert(static_cast<int>(level2::Moment::ref) == 0);
static_assert(static_cast<int>(level2::Moment::cfp) == 6);

// The places of the sections. Only padding is between the sections, so their sizes determine their
// places. layout_of() does not overflow if its arguments are within the limits above.
struct Layout {
    std::uint64_t levels_offset = page_size;
    std::uint64_t description_offset = 0;
    std::uint64_t table_offset = 0;
    std::uint64_t states_offset = 0;
    std::uint64_t codes_offset = 0;
    std::uint64_t codes_size = 0;
    std::uint64_t file_size = 0;
};
[[nodiscard]] constexpr std::uint64_t round_up(std::uint64_t n, std::uint64_t multiple) {
    return (n + multiple - 1) / multiple * multiple;
}
[[nodiscard]] constexpr Layout layout_of(std::uint64_t levels, std::uint64_t description_size,
                                         std::uint64_t bricks, std::uint64_t states_size,
                                         std::uint64_t code_bytes) {
    Layout at;
    at.description_offset = at.levels_offset + levels * sizeof(double);
    at.table_offset = round_up(at.description_offset + description_size, 8);
    at.states_offset = at.table_offset + bricks * sizeof(BrickEntry);
    at.codes_offset = round_up(at.states_offset + states_size, page_size);
    at.codes_size = bricks * grid::brick_cells * code_bytes;
    at.file_size = at.codes_offset + at.codes_size;
    return at;
}
// Returns the layout `at` with the codes packed into `codes_size` bytes.
[[nodiscard]] constexpr Layout packed_layout(Layout at, std::uint64_t codes_size) {
    at.codes_size = codes_size;
    at.file_size = at.codes_offset + codes_size;
    return at;
}

}  // namespace stormcellar::cache::format

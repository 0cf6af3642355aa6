// web/data/grids/packed_grid.h -- the packed form of a grid, for browsers.
//
// docs/web/packed-grid.md specifies the bytes; the struct below asserts the offsets. A client gets
// the grid as a whole, or first its table and then its bricks by ranges of the table. All of these
// have the same form, and the header says which sections follow.
//
// Units     As in the cache's files (docs/cache-format.md): meters, degrees, milliseconds.
// Threads   Pure functions.
// Errors    See each function.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::web {

inline constexpr std::array<unsigned char, 8> packed_magic = {0x89, 'S',  'C',  'P',
                                                              '\r', '\n', 0x1A, '\n'};
inline constexpr std::uint32_t packed_version = 1;

enum class PackedPart : std::uint32_t {
    whole = 0,   // levels, sites, table, and the states and codes of all bricks
    table = 1,   // levels, sites and table
    bricks = 2,  // the states and codes of a range of bricks
};

// The header, at offset 0, little-endian, as docs/web/packed-grid.md specifies it.
struct PackedHeader {
    std::array<unsigned char, 8> magic = packed_magic;
    std::uint32_t version = packed_version;
    std::uint32_t header_size = 256;
    std::uint64_t size = 0;  // of all bytes
    std::uint64_t id = 0;    // hash of the grid's bytes in the cache
    std::uint32_t projection = 0;
    std::uint32_t nx = 0, ny = 0, nz = 0;
    double center_latitude_deg = 0, center_longitude_deg = 0;
    double spacing = 0;  // meters; degrees for latitude_longitude
    double parallel_1_deg = 0, parallel_2_deg = 0;
    double offset_x_cells = 0, offset_y_cells = 0;
    std::uint32_t moment = 0;
    std::uint32_t code_bytes = 1;
    float first_value = 0, step = 0;  // value = first_value + step * (code - 3)
    std::uint32_t brick_edge = grid::brick_edge;
    std::uint32_t bricks_x = 0, bricks_y = 0, bricks_z = 0;
    std::int64_t time_ms = 0, start_time_ms = 0, end_time_ms = 0;
    std::uint32_t part = 0;       // PackedPart
    std::uint32_t halved = 0;     // number of halvings of columns and rows
    std::uint32_t halved_by = 0;  // 0 not halved, 1 maximum, 2 mean
    // Bit 0: the volume is partial. Bit 1: the grid is provisional. Bit 2: only cells with values
    // have codes.
    std::uint32_t flags = 0;
    std::uint32_t first_brick = 0, end_brick = 0;      // the range whose states and codes follow
    std::uint32_t first_states = 0, states_count = 0;  // first block in the table; their number
    std::uint32_t first_codes = 0, codes_count = 0;
    std::uint32_t site_count = 0, table_count = 0;
    std::uint64_t levels_offset = 0;  // nz doubles; an offset of 0 means that the section is absent
    std::uint64_t sites_offset = 0;
    std::uint64_t table_offset = 0;
    std::uint64_t states_offset = 0;
    std::uint64_t codes_offset = 0;
    // Echo with a lesser probability of weather is left out; 0: all echo is here.
    float least_probability = 0;
    float left_out_share = 0;  // of the echo; negative if the sites of a mosaic differ
};
static_assert(sizeof(PackedHeader) == 256);
static_assert(offsetof(PackedHeader, version) == 8);
static_assert(offsetof(PackedHeader, header_size) == 12);
static_assert(offsetof(PackedHeader, size) == 16);
static_assert(offsetof(PackedHeader, id) == 24);
static_assert(offsetof(PackedHeader, projection) == 32);
static_assert(offsetof(PackedHeader, nx) == 36);
static_assert(offsetof(PackedHeader, ny) == 40);
static_assert(offsetof(PackedHeader, nz) == 44);
static_assert(offsetof(PackedHeader, center_latitude_deg) == 48);
static_assert(offsetof(PackedHeader, center_longitude_deg) == 56);
static_assert(offsetof(PackedHeader, spacing) == 64);
static_assert(offsetof(PackedHeader, parallel_1_deg) == 72);
static_assert(offsetof(PackedHeader, parallel_2_deg) == 80);
static_assert(offsetof(PackedHeader, offset_x_cells) == 88);
static_assert(offsetof(PackedHeader, offset_y_cells) == 96);
static_assert(offsetof(PackedHeader, moment) == 104);
static_assert(offsetof(PackedHeader, code_bytes) == 108);
static_assert(offsetof(PackedHeader, first_value) == 112);
static_assert(offsetof(PackedHeader, step) == 116);
static_assert(offsetof(PackedHeader, brick_edge) == 120);
static_assert(offsetof(PackedHeader, bricks_x) == 124);
static_assert(offsetof(PackedHeader, bricks_y) == 128);
static_assert(offsetof(PackedHeader, bricks_z) == 132);
static_assert(offsetof(PackedHeader, time_ms) == 136);
static_assert(offsetof(PackedHeader, start_time_ms) == 144);
static_assert(offsetof(PackedHeader, end_time_ms) == 152);
static_assert(offsetof(PackedHeader, part) == 160);
static_assert(offsetof(PackedHeader, halved) == 164);
static_assert(offsetof(PackedHeader, halved_by) == 168);
static_assert(offsetof(PackedHeader, flags) == 172);
static_assert(offsetof(PackedHeader, first_brick) == 176);
static_assert(offsetof(PackedHeader, end_brick) == 180);
static_assert(offsetof(PackedHeader, first_states) == 184);
static_assert(offsetof(PackedHeader, states_count) == 188);
static_assert(offsetof(PackedHeader, first_codes) == 192);
static_assert(offsetof(PackedHeader, codes_count) == 196);
static_assert(offsetof(PackedHeader, site_count) == 200);
static_assert(offsetof(PackedHeader, table_count) == 204);
static_assert(offsetof(PackedHeader, levels_offset) == 208);
static_assert(offsetof(PackedHeader, sites_offset) == 216);
static_assert(offsetof(PackedHeader, table_offset) == 224);
static_assert(offsetof(PackedHeader, states_offset) == 232);
static_assert(offsetof(PackedHeader, codes_offset) == 240);
static_assert(offsetof(PackedHeader, least_probability) == 248);
static_assert(offsetof(PackedHeader, left_out_share) == 252);

struct PackedSite {
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
    std::array<char, 8> icao{};  // padded with zeros
};
static_assert(sizeof(PackedSite) == 32);

// One brick. `at` is its index among the blocks of states (kind 1), or among the codes of stored
// bricks (kind 2).
struct PackedBrick {
    std::uint8_t kind = 0;   // grid::BrickKind
    std::uint8_t state = 0;  // kind 0: the state of all its cells
    std::uint16_t value_count = 0;
    std::uint16_t min_code = 0, max_code = 0;
    std::uint32_t at = 0;
};
static_assert(sizeof(PackedBrick) == 12);
static_assert(offsetof(PackedBrick, value_count) == 2);
static_assert(offsetof(PackedBrick, min_code) == 4);
static_assert(offsetof(PackedBrick, max_code) == 6);
static_assert(offsetof(PackedBrick, at) == 8);

// The grid to pack, and what the header says about it.
struct PackedSource {
    const cache::GridDescription* description = nullptr;  // has the spec of `view`
    grid::BrickView view;
    std::uint64_t id = 0;
    std::uint32_t halved = 0, halved_by = 0;
    // If true, a whole grid has the states of all bricks that are not uniform, but the codes only
    // of cells with values.
    bool values_alone = false;
};

// Limits of one answer before compression.
inline constexpr std::uint64_t most_packed_bytes = std::uint64_t{64} << 20;
inline constexpr std::size_t most_bricks_of_a_range = 16384;

// Returns the bytes of a whole grid, of its table, or of the bricks [first, end). The caller must
// check afterward that the file is whole. Errors: bad_argument for a range that is empty or beyond
// the table, and for an answer beyond the limits above; the message says what to request instead.
[[nodiscard]] Result<std::string> pack_whole(const PackedSource& source);
[[nodiscard]] Result<std::string> pack_table(const PackedSource& source);
// Returns the whole grid if it has at most `most` bytes, else its table.
[[nodiscard]] Result<std::string> pack_whole_or_table(const PackedSource& source,
                                                      std::uint64_t most_bytes);
[[nodiscard]] Result<std::string> pack_bricks(const PackedSource& source, std::size_t first,
                                              std::size_t end);

}  // namespace stormcellar::web

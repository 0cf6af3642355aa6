#include "web/data/grids/packed_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "retrieve/derived/quality_note.h"

namespace stormcellar::web {
namespace {

static_assert(std::endian::native == std::endian::little, "the packed form is little-endian");

constexpr std::size_t states_block_bytes = 1024;
constexpr std::uint64_t section_alignment = 16;
constexpr std::uint32_t values_alone_flag = 4;

std::int64_t packed_time(UtcTime time) {
    return time.time_since_epoch().count();
}

PackedHeader header_of(const PackedSource& source) {
    const cache::GridDescription& description = *source.description;
    const grid::GridSpec& spec = *source.view.spec;
    const grid::Quantization& codes = source.view.quantization;
    PackedHeader header;
    header.id = source.id;
    header.projection = static_cast<std::uint32_t>(spec.projection);
    header.nx = static_cast<std::uint32_t>(spec.nx);
    header.ny = static_cast<std::uint32_t>(spec.ny);
    header.nz = static_cast<std::uint32_t>(spec.nz());
    header.center_latitude_deg = spec.center_latitude_deg;
    header.center_longitude_deg = spec.center_longitude_deg;
    header.spacing = spec.in_degrees() ? spec.spacing_deg : spec.spacing_m;
    header.parallel_1_deg = spec.parallels_deg[0];
    header.parallel_2_deg = spec.parallels_deg[1];
    header.offset_x_cells = spec.offset_x_cells;
    header.offset_y_cells = spec.offset_y_cells;
    header.moment = static_cast<std::uint32_t>(description.moment);
    header.code_bytes = static_cast<std::uint32_t>(codes.code_bytes);
    header.first_value = codes.first_value;
    header.step = codes.step;
    header.bricks_x = static_cast<std::uint32_t>(source.view.bricks_x);
    header.bricks_y = static_cast<std::uint32_t>(source.view.bricks_y);
    header.bricks_z = static_cast<std::uint32_t>(source.view.bricks_z);
    header.time_ms = packed_time(description.time);
    header.start_time_ms = packed_time(description.start_time);
    header.end_time_ms = packed_time(description.end_time);
    header.halved = source.halved;
    header.halved_by = source.halved_by;
    header.flags =
        (description.provenance.partial ? 1U : 0U) | (description.provenance.provisional ? 2U : 0U);
    if (const auto quality = retrieve::quality_note_in(description.provenance.notes)) {
        header.least_probability = static_cast<float>(quality->least);
        header.left_out_share = static_cast<float>(quality->share.value_or(-1));
    }
    return header;
}

// The numbers of blocks of states, and of bricks with codes, in a range of the table.
struct BlockCounts {
    std::uint32_t states = 0, codes = 0;
};
BlockCounts count_blocks(std::span<const grid::BrickEntry> bricks) {
    BlockCounts counts;
    for (const grid::BrickEntry& brick : bricks) {
        if (brick.kind == grid::BrickKind::status_only) ++counts.states;
        if (brick.kind == grid::BrickKind::stored) ++counts.codes;
    }
    return counts;
}

class PackedWriter {
  public:
    explicit PackedWriter(PackedHeader header) : header_(header) {
        bytes_.resize(sizeof(PackedHeader));
    }

    void reserve(std::uint64_t size) { bytes_.reserve(size); }
    void append(const void* from, std::size_t size) {
        bytes_.append(static_cast<const char*>(from), size);
    }
    // Aligns the end of the bytes, and returns where the next section begins.
    std::uint64_t begin_section() {
        bytes_.resize((bytes_.size() + section_alignment - 1) / section_alignment *
                      section_alignment);
        return bytes_.size();
    }
    [[nodiscard]] PackedHeader& header() { return header_; }
    std::string finish() {
        header_.size = bytes_.size();
        std::memcpy(bytes_.data(), &header_, sizeof header_);
        return std::move(bytes_);
    }

  private:
    PackedHeader header_;
    std::string bytes_;
};

void append_places(PackedWriter& writer, const PackedSource& source) {
    const auto& levels = source.view.spec->levels_m;
    writer.header().levels_offset = writer.begin_section();
    writer.append(levels.data(), levels.size() * sizeof(double));
    writer.header().sites_offset = writer.begin_section();
    writer.header().site_count = static_cast<std::uint32_t>(source.description->sites.size());
    for (const grid::SitePosition& site : source.description->sites) {
        PackedSite packed{site.latitude_deg, site.longitude_deg, site.altitude_m, {}};
        std::copy_n(site.icao.begin(), std::min(site.icao.size(), packed.icao.size()),
                    packed.icao.begin());
        writer.append(&packed, sizeof packed);
    }
}

void append_table(PackedWriter& writer, const PackedSource& source) {
    writer.header().table_offset = writer.begin_section();
    writer.header().table_count = static_cast<std::uint32_t>(source.view.bricks.size());
    BlockCounts counts;
    std::vector<PackedBrick> table;
    table.reserve(source.view.bricks.size());
    for (const grid::BrickEntry& brick : source.view.bricks) {
        PackedBrick packed;
        packed.kind = static_cast<std::uint8_t>(brick.kind);
        switch (brick.kind) {
            case grid::BrickKind::uniform:
                packed.state = static_cast<std::uint8_t>(brick.uniform_status);
                break;
            case grid::BrickKind::status_only:
                packed.at = counts.states++;
                break;
            case grid::BrickKind::stored:
                packed.value_count = brick.value_count;
                packed.min_code = brick.min_code;
                packed.max_code = brick.max_code;
                packed.at = counts.codes++;
                break;
        }
        table.push_back(packed);
    }
    writer.append(table.data(), table.size() * sizeof(PackedBrick));
}

void append_blocks(PackedWriter& writer, const PackedSource& source, std::size_t first,
                   std::size_t end) {
    const grid::BrickView& view = source.view;
    const auto bricks = view.bricks.subspan(first, end - first);
    const BlockCounts before = count_blocks(view.bricks.first(first));
    const BlockCounts counts = count_blocks(bricks);
    PackedHeader& header = writer.header();
    header.first_brick = static_cast<std::uint32_t>(first);
    header.end_brick = static_cast<std::uint32_t>(end);
    header.first_states = before.states;
    header.states_count = counts.states;
    header.first_codes = before.codes;
    header.codes_count = counts.codes;
    header.states_offset = writer.begin_section();
    for (const grid::BrickEntry& brick : bricks) {
        if (brick.kind != grid::BrickKind::status_only) continue;
        writer.append(view.states.data() + std::size_t{brick.status_index} * states_block_bytes,
                      states_block_bytes);
    }
    header.codes_offset = writer.begin_section();
    const std::size_t brick_bytes =
        grid::brick_cells * static_cast<std::size_t>(view.quantization.code_bytes);
    for (std::size_t i = first; i < end; ++i) {
        if (view.bricks[i].kind != grid::BrickKind::stored) continue;
        writer.append(view.codes.data() + i * brick_bytes, brick_bytes);
    }
}

// Returns the states of a stored brick, four cells to a byte. Appends the codes of its values to
// `values`.
template <class Code>
std::array<std::uint8_t, states_block_bytes> split_brick(const std::byte* bytes,
                                                         std::string& values) {
    std::array<Code, grid::brick_cells> codes;
    std::memcpy(codes.data(), bytes, sizeof codes);
    std::array<std::uint8_t, states_block_bytes> states{};
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const auto state = std::min<Code>(codes[i], grid::first_value_code);
        states[i / 4] = static_cast<std::uint8_t>(states[i / 4] | state << (2 * (i % 4)));
        if (state == grid::first_value_code)
            values.append(reinterpret_cast<const char*>(&codes[i]), sizeof(Code));
    }
    return states;
}

// Replaces each code by its difference from the code before it. Neighbors are alike, so this
// compresses better.
template <class Code>
void subtract_neighbors(std::string& codes) {
    Code before = 0;
    for (std::size_t at = 0; at < codes.size(); at += sizeof(Code)) {
        Code code{};
        std::memcpy(&code, &codes[at], sizeof code);
        const auto difference = static_cast<Code>(code - before);
        std::memcpy(&codes[at], &difference, sizeof difference);
        before = code;
    }
}

// Appends the states of all bricks that are not uniform, in the order of the table, and after these
// the codes of values.
void append_values(PackedWriter& writer, const PackedSource& source) {
    const grid::BrickView& view = source.view;
    const auto code_bytes = static_cast<std::size_t>(view.quantization.code_bytes);
    PackedHeader& header = writer.header();
    header.flags |= values_alone_flag;
    header.end_brick = static_cast<std::uint32_t>(view.bricks.size());
    header.states_offset = writer.begin_section();
    std::string values;
    for (std::size_t i = 0; i < view.bricks.size(); ++i) {
        const grid::BrickEntry& brick = view.bricks[i];
        if (brick.kind == grid::BrickKind::uniform) continue;
        ++header.states_count;
        if (brick.kind == grid::BrickKind::status_only) {
            writer.append(view.states.data() + std::size_t{brick.status_index} * states_block_bytes,
                          states_block_bytes);
            continue;
        }
        const std::byte* codes = view.codes.data() + i * grid::brick_cells * code_bytes;
        const auto states = code_bytes == 1 ? split_brick<std::uint8_t>(codes, values)
                                            : split_brick<std::uint16_t>(codes, values);
        writer.append(states.data(), states.size());
    }
    if (code_bytes == 1) {
        subtract_neighbors<std::uint8_t>(values);
    } else {
        subtract_neighbors<std::uint16_t>(values);
    }
    header.codes_count = static_cast<std::uint32_t>(values.size() / code_bytes);
    header.codes_offset = writer.begin_section();
    writer.append(values.data(), values.size());
}

std::uint64_t bytes_of_blocks(const grid::BrickView& view, std::size_t first, std::size_t end) {
    const BlockCounts counts = count_blocks(view.bricks.subspan(first, end - first));
    return std::uint64_t{counts.states} * states_block_bytes +
           std::uint64_t{counts.codes} * grid::brick_cells *
               static_cast<std::uint64_t>(view.quantization.code_bytes);
}

std::uint64_t bytes_of_places(const PackedSource& source) {
    return sizeof(PackedHeader) + 5 * section_alignment +
           source.view.spec->levels_m.size() * sizeof(double) +
           source.description->sites.size() * sizeof(PackedSite) +
           source.view.bricks.size() * sizeof(PackedBrick);
}

std::uint64_t bytes_of_whole(const PackedSource& source) {
    return bytes_of_places(source) + bytes_of_blocks(source.view, 0, source.view.bricks.size());
}

}  // namespace

Result<std::string> pack_whole(const PackedSource& source) {
    const std::size_t bricks = source.view.bricks.size();
    const std::uint64_t size = bytes_of_whole(source);
    if (size > most_packed_bytes) {
        return fail(ErrorCode::bad_argument,
                    "the grid takes {} bytes, at most {} are sent at once: ask for part=table, and "
                    "then for bricks=FIRST-LAST; or for half=1 or more",
                    size, most_packed_bytes);
    }
    PackedWriter writer(header_of(source));
    writer.reserve(size);
    append_places(writer, source);
    append_table(writer, source);
    if (source.values_alone) {
        append_values(writer, source);
    } else {
        append_blocks(writer, source, 0, bricks);
    }
    return writer.finish();
}

Result<std::string> pack_table(const PackedSource& source) {
    PackedWriter writer(header_of(source));
    writer.header().part = static_cast<std::uint32_t>(PackedPart::table);
    writer.reserve(bytes_of_places(source));
    append_places(writer, source);
    append_table(writer, source);
    return writer.finish();
}

Result<std::string> pack_whole_or_table(const PackedSource& source, std::uint64_t most_bytes) {
    return bytes_of_whole(source) > most_bytes ? pack_table(source) : pack_whole(source);
}

Result<std::string> pack_bricks(const PackedSource& source, std::size_t first, std::size_t end) {
    const std::size_t bricks = source.view.bricks.size();
    if (first >= end || end > bricks) {
        return fail(ErrorCode::bad_argument, "bricks: the grid has the bricks 0-{}", bricks - 1);
    }
    if (end - first > most_bricks_of_a_range) {
        return fail(ErrorCode::bad_argument, "bricks: at most {} are sent at once, not {}",
                    most_bricks_of_a_range, end - first);
    }
    const std::uint64_t size = bytes_of_blocks(source.view, first, end);
    if (size > most_packed_bytes) {
        return fail(ErrorCode::bad_argument,
                    "bricks: these take {} bytes, at most {} are sent at once", size,
                    most_packed_bytes);
    }
    PackedWriter writer(header_of(source));
    writer.header().part = static_cast<std::uint32_t>(PackedPart::bricks);
    writer.reserve(sizeof(PackedHeader) + 2 * section_alignment + size);
    append_blocks(writer, source, first, end);
    return writer.finish();
}

}  // namespace stormcellar::web

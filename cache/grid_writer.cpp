// Writes grid files: first the metadata, and then every run of stored bricks at its own place.
#include <algorithm>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include "base/checksum.h"
#include "cache/check.h"
#include "cache/description.h"
#include "cache/format.h"
#include "cache/packing.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::cache {
namespace {

using grid::BrickEntry;
using grid::BrickKind;
using grid::BrickView;

std::int64_t milliseconds_of(UtcTime time) {
    return time.time_since_epoch().count();
}

// Checks that the view is consistent, before its spans are read.
Status check_view(const GridDescription& description, const BrickView& view) {
    const grid::GridSpec& spec = description.spec;
    const std::uint64_t bricks = brick_count(spec);
    const bool shape_fits = view.bricks_x == grid::bricks_along(spec.nx) &&
                            view.bricks_y == grid::bricks_along(spec.ny) &&
                            view.bricks_z == grid::bricks_along(spec.nz()) &&
                            view.bricks.size() == bricks;
    const std::uint64_t code_bytes = static_cast<std::uint64_t>(view.quantization.code_bytes);
    if (!shape_fits || view.codes.size() != bricks * grid::brick_cells * code_bytes) {
        return fail(ErrorCode::corrupt, "the bricks do not have the shape of the grid");
    }
    for (const BrickEntry& entry : view.bricks) {
        if (entry.kind != BrickKind::status_only) continue;
        if ((entry.status_index + std::uint64_t{1}) * format::status_block_bytes >
            view.states.size()) {
            return fail(ErrorCode::corrupt, "a brick refers to states that do not exist");
        }
    }
    return {};
}

struct Tables {
    std::vector<BrickEntry> bricks;
    std::vector<std::byte> states;
    std::vector<std::byte> packed;  // the codes of all stored bricks, if they are packed
};

std::span<const std::byte> codes_of(const BrickView& view, std::size_t brick) {
    const std::size_t size =
        grid::brick_cells * static_cast<std::size_t>(view.quantization.code_bytes);
    return view.codes.subspan(brick * size, size);
}

// Makes the table in its only allowed form, so that the same cells always give the same bytes:
// unused fields are zero, and each status block occurs once, in order. Computes counts and
// checksums from the cells, so that a file always agrees with its own table.
Tables canonical_tables(const BrickView& view, Packing packing) {
    Tables tables;
    tables.bricks.reserve(view.bricks.size());
    for (std::size_t i = 0; i < view.bricks.size(); ++i) {
        const BrickEntry& from = view.bricks[i];
        BrickEntry entry;
        entry.kind = from.kind;
        if (from.kind == BrickKind::uniform) {
            entry.uniform_status = from.uniform_status;
        } else if (from.kind == BrickKind::status_only) {
            const auto block = view.states.subspan(from.status_index * format::status_block_bytes,
                                                   format::status_block_bytes);
            entry.status_index =
                static_cast<std::uint32_t>(tables.states.size() / format::status_block_bytes);
            entry.checksum = xxh3_64(block);
            tables.states.insert(tables.states.end(), block.begin(), block.end());
        } else {
            const auto codes = codes_of(view, i);
            const CodeRange range = code_range(codes, view.quantization.code_bytes);
            entry.value_count = range.value_count;
            entry.min_code = range.min_code;
            entry.max_code = range.max_code;
            entry.checksum = xxh3_64(codes);
            if (packing != Packing::none) {
                const std::vector<std::byte> packed = pack_brick(codes);
                entry.packed_bytes = static_cast<std::uint32_t>(packed.size());
                tables.packed.insert(tables.packed.end(), packed.begin(), packed.end());
            }
        }
        tables.bricks.push_back(entry);
    }
    return tables;
}

format::FileHeader header_of(const GridDescription& description, const BrickView& view,
                             const format::Layout& at, std::uint64_t description_size,
                             std::uint64_t states_size, Packing packing) {
    const grid::GridSpec& spec = description.spec;
    format::FileHeader header;
    header.magic = format::magic;
    header.byte_order = format::byte_order_mark;
    header.version = format::version;
    const bool is_window = spec.offset_x_cells != 0 || spec.offset_y_cells != 0;
    header.required_features = (is_window ? format::feature_window : 0) |
                               (packing == Packing::none ? 0 : format::packed_codes);
    header.header_size = static_cast<std::uint32_t>(format::page_size);
    header.file_size = at.file_size;
    header.levels_offset = at.levels_offset;
    header.description_offset = at.description_offset;
    header.description_size = description_size;
    header.table_offset = at.table_offset;
    header.states_offset = at.states_offset;
    header.states_size = states_size;
    header.codes_offset = at.codes_offset;
    header.codes_size = at.codes_size;
    header.projection = static_cast<std::uint32_t>(spec.projection);
    header.nx = static_cast<std::uint32_t>(spec.nx);
    header.ny = static_cast<std::uint32_t>(spec.ny);
    header.nz = static_cast<std::uint32_t>(spec.nz());
    header.center_latitude_deg = spec.center_latitude_deg;
    header.center_longitude_deg = spec.center_longitude_deg;
    header.spacing = spec.in_degrees() ? spec.spacing_deg : spec.spacing_m;
    header.moment = static_cast<std::uint32_t>(description.moment);
    header.code_bytes = static_cast<std::uint32_t>(view.quantization.code_bytes);
    header.first_value = view.quantization.first_value;
    header.step = view.quantization.step;
    header.brick_edge = grid::brick_edge;
    header.bricks_x = static_cast<std::uint32_t>(view.bricks_x);
    header.bricks_y = static_cast<std::uint32_t>(view.bricks_y);
    header.bricks_z = static_cast<std::uint32_t>(view.bricks_z);
    header.time_ms = milliseconds_of(description.time);
    header.start_time_ms = milliseconds_of(description.start_time);
    header.end_time_ms = milliseconds_of(description.end_time);
    header.offset_x_cells = spec.offset_x_cells;
    header.offset_y_cells = spec.offset_y_cells;
    return header;
}

template <class T>
void put(std::vector<std::byte>& bytes, std::uint64_t offset, std::span<const T> items) {
    if (!items.empty()) std::memcpy(bytes.data() + offset, items.data(), items.size_bytes());
}

// Returns all bytes before the codes, including the checksum.
std::vector<std::byte> metadata_bytes(const GridDescription& description, const BrickView& view,
                                      const format::Layout& at,
                                      std::span<const std::byte> description_bytes,
                                      const Tables& tables, Packing packing) {
    std::vector<std::byte> bytes(at.codes_offset);
    format::FileHeader header =
        header_of(description, view, at, description_bytes.size(), tables.states.size(), packing);
    put(bytes, 0, std::span<const format::FileHeader>(&header, 1));
    put(bytes, at.levels_offset, std::span<const double>(description.spec.levels_m));
    put(bytes, at.description_offset, description_bytes);
    put(bytes, at.table_offset, std::span<const BrickEntry>(tables.bricks));
    put(bytes, at.states_offset, std::span<const std::byte>(tables.states));
    header.checksum = xxh3_64(bytes);
    put(bytes, 0, std::span<const format::FileHeader>(&header, 1));
    return bytes;
}

// Writes each run of consecutive stored bricks with one call.
Status write_codes(AtomicFile& file, const BrickView& view, const format::Layout& at) {
    const std::uint64_t brick_bytes =
        grid::brick_cells * static_cast<std::uint64_t>(view.quantization.code_bytes);
    const auto is_stored = [&](std::size_t i) { return view.bricks[i].kind == BrickKind::stored; };
    for (std::size_t first = 0; first < view.bricks.size();) {
        if (!is_stored(first)) {
            ++first;
            continue;
        }
        std::size_t end = first + 1;
        while (end < view.bricks.size() && is_stored(end))
            ++end;
        const auto run = view.codes.subspan(first * brick_bytes, (end - first) * brick_bytes);
        if (Status written = file.write_at(at.codes_offset + first * brick_bytes, run); !written) {
            return written;
        }
        first = end;
    }
    return {};
}

// Returns the size of the file on disk, or `written` if the file was already removed.
std::uint64_t size_on_disk(const std::filesystem::path& path, std::uint64_t written) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0) return written;
    return static_cast<std::uint64_t>(facts.st_blocks) * 512;
}

Status bad_argument(const std::filesystem::path& path, const Status& status) {
    return fail(ErrorCode::bad_argument, "{}: {}", path.native(), status.error().message);
}

}  // namespace

GridDescription describe(const grid::Grid& grid) {
    return {grid.spec,     grid.moment, grid.time,      grid.start_time,
            grid.end_time, grid.sites,  grid.provenance};
}

Result<std::uint64_t> write_grid_file(FileSystem& file_system, const std::filesystem::path& path,
                                      const GridDescription& description,
                                      const grid::BrickView& view, Packing packing) {
    Status good = check_description(description, view.quantization);
    if (good) good = check_view(description, view);
    if (!good) return pass_on(bad_argument(path, good));
    const Tables tables = canonical_tables(view, packing);
    good = check_bricks(tables.bricks, tables.states, view.quantization, packing);
    if (!good) return pass_on(bad_argument(path, good));

    const std::vector<std::byte> names = encode_description(description);
    format::Layout at = format::layout_of(description.spec.levels_m.size(), names.size(),
                                          tables.bricks.size(), tables.states.size(),
                                          static_cast<std::uint64_t>(view.quantization.code_bytes));
    if (packing != Packing::none) at = format::packed_layout(at, tables.packed.size());
    if (names.size() > format::max_description_bytes) {
        return fail(ErrorCode::bad_argument, "{}: {} bytes of names and notes, more than {}",
                    path.native(), names.size(), format::max_description_bytes);
    }
    if (at.codes_offset > format::max_metadata_bytes) {
        return fail(ErrorCode::bad_argument, "{}: {} bytes of metadata, more than {}",
                    path.native(), at.codes_offset, format::max_metadata_bytes);
    }

    Result<AtomicFile> file = AtomicFile::create(file_system, path);
    if (!file) return pass_on(file);
    const std::vector<std::byte> metadata =
        metadata_bytes(description, view, at, names, tables, packing);
    Status written = file->set_size(at.file_size);
    if (written) written = file->write_at(0, metadata);
    if (written && packing != Packing::none) {
        written = file->write_at(at.codes_offset, tables.packed);
    } else if (written) {
        written = write_codes(*file, view, at);
    }
    if (written) written = file->commit();
    if (!written) return pass_on(written);

    if (packing != Packing::none) return size_on_disk(path, at.file_size);
    const auto stored =
        std::count_if(tables.bricks.begin(), tables.bricks.end(),
                      [](const BrickEntry& b) { return b.kind == BrickKind::stored; });
    return size_on_disk(
        path, metadata.size() + static_cast<std::uint64_t>(stored) * grid::brick_cells *
                                    static_cast<std::uint64_t>(view.quantization.code_bytes));
}

std::uint64_t most_bytes_on_disk(const GridDescription& description, const grid::BrickView& view,
                                 std::uint64_t block_bytes) {
    const auto of_kind = [&](BrickKind kind) {
        return static_cast<std::uint64_t>(
            std::count_if(view.bricks.begin(), view.bricks.end(),
                          [kind](const BrickEntry& entry) { return entry.kind == kind; }));
    };
    const auto code_bytes = static_cast<std::uint64_t>(view.quantization.code_bytes);
    const format::Layout at =
        format::layout_of(description.spec.levels_m.size(), encode_description(description).size(),
                          view.bricks.size(),
                          of_kind(BrickKind::status_only) * format::status_block_bytes, code_bytes);
    // Count the blocks of the metadata, and then the blocks of each stored brick, but not a block
    // that the brick shares with the previous brick.
    std::uint64_t end_block = format::round_up(at.codes_offset, block_bytes) / block_bytes;
    std::uint64_t blocks = end_block;
    for (std::size_t i = 0; i < view.bricks.size(); ++i) {
        if (view.bricks[i].kind != BrickKind::stored) continue;
        const std::uint64_t begin = at.codes_offset + i * grid::brick_cells * code_bytes;
        const std::uint64_t end = begin + grid::brick_cells * code_bytes;
        const std::uint64_t first = std::max(end_block, begin / block_bytes);
        end_block = std::max(end_block, format::round_up(end, block_bytes) / block_bytes);
        blocks += end_block - std::min(first, end_block);
    }
    return (blocks + blocks / 64 + 4) * block_bytes;
}

}  // namespace stormcellar::cache

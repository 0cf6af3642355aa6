// Opens grid files, and uses nothing in a file before it is checked.
//
// All bytes that control the reader (header, table, states, names) are copied into our own memory
// and checked there. So another program that alters or cuts the file later cannot mislead the
// reader. Only unpacked codes stay on disk and are mapped.
#include "stormcellar/cache/grid_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>

#include "base/checksum.h"
#include "cache/check.h"
#include "cache/description.h"
#include "cache/file_io.h"
#include "cache/format.h"
#include "cache/grid_facts.h"
#include "cache/grid_file_mapping.h"
#include "cache/packing.h"

namespace stormcellar::cache {
namespace {

using format::FileHeader;
using grid::BrickEntry;

// Checks the fields on which the reading of other fields depends. Afterward, sizes can be computed
// without overflow.
Status check_identity(const FileHeader& header) {
    if (header.magic != format::magic) {
        return fail(ErrorCode::corrupt, "is not a stormcellar grid file");
    }
    if (header.byte_order != format::byte_order_mark) {
        return fail(ErrorCode::unsupported, "was written in another byte order");
    }
    const bool known = (header.required_features & ~format::known_features) == 0;
    if (header.version < format::oldest_version || header.version > format::version || !known) {
        return fail(ErrorCode::unsupported,
                    "has version {} and features {:#x}; this software reads versions {} to {} and "
                    "features {:#x}",
                    header.version, header.required_features, format::oldest_version,
                    format::version, format::known_features);
    }
    const bool is_window = header.offset_x_cells != 0 || header.offset_y_cells != 0;
    if (is_window != ((header.required_features & format::feature_window) != 0)) {
        return fail(ErrorCode::corrupt,
                    "features and offsets of the header disagree on whether this is a window");
    }
    const bool possible = header.header_size == format::page_size && header.nx >= 1 &&
                          header.nx <= 16384 && header.ny >= 1 && header.ny <= 16384 &&
                          header.nz >= 1 && header.nz <= 1024 &&
                          (header.code_bytes == 1 || header.code_bytes == 2) &&
                          header.brick_edge == grid::brick_edge &&
                          header.projection < grid::projection_facts.size() &&
                          header.moment < static_cast<std::uint32_t>(level2::moment_count) &&
                          header.description_size <= format::max_description_bytes &&
                          header.states_size <= format::max_metadata_bytes;
    if (!possible) return fail(ErrorCode::corrupt, "the header holds impossible sizes");
    return {};
}

bool is_packed(const FileHeader& header) {
    return (header.required_features & format::packed_codes) != 0;
}

// Returns the layout that follows from the sizes in the header. Fails if the header's offsets
// differ from this layout.
Result<format::Layout> checked_layout(const FileHeader& header) {
    const auto along = [](std::uint32_t cells) {
        return static_cast<std::uint32_t>(grid::bricks_along(static_cast<int>(cells)));
    };
    const std::uint64_t bricks = std::uint64_t{header.bricks_x} * header.bricks_y * header.bricks_z;
    if (header.bricks_x != along(header.nx) || header.bricks_y != along(header.ny) ||
        header.bricks_z != along(header.nz) || bricks > format::max_bricks) {
        return fail(ErrorCode::corrupt, "the header holds an impossible number of bricks");
    }
    format::Layout at = format::layout_of(header.nz, header.description_size, bricks,
                                          header.states_size, header.code_bytes);
    // Packed codes are never longer than unpacked codes. The table must give the same length as the
    // header; this is checked later.
    if (is_packed(header) && header.codes_size <= at.codes_size) {
        at = format::packed_layout(at, header.codes_size);
    }
    const bool same = header.levels_offset == at.levels_offset &&
                      header.description_offset == at.description_offset &&
                      header.table_offset == at.table_offset &&
                      header.states_offset == at.states_offset &&
                      header.codes_offset == at.codes_offset &&
                      header.codes_size == at.codes_size && header.file_size == at.file_size;
    if (!same || at.codes_offset > format::max_metadata_bytes) {
        return fail(ErrorCode::corrupt, "the header holds impossible offsets");
    }
    return at;
}

Status check_checksum(std::vector<std::byte>& metadata, std::uint64_t expected) {
    const auto field =
        std::span(metadata).subspan(offsetof(FileHeader, checksum), sizeof(std::uint64_t));
    std::fill(field.begin(), field.end(), std::byte{0});
    if (xxh3_64(metadata) != expected) {
        return fail(ErrorCode::corrupt, "the checksum of header, table and states is wrong");
    }
    return {};
}

UtcTime time_of(std::int64_t milliseconds) {
    return UtcTime{std::chrono::milliseconds{milliseconds}};
}

GridDescription description_of(const FileHeader& header, std::span<const std::byte> levels) {
    GridDescription description;
    grid::GridSpec& spec = description.spec;
    spec.projection = static_cast<grid::Projection>(header.projection);
    spec.center_latitude_deg = header.center_latitude_deg;
    spec.center_longitude_deg = header.center_longitude_deg;
    const bool in_degrees = spec.in_degrees();
    spec.spacing_m = in_degrees ? 0 : header.spacing;
    spec.spacing_deg = in_degrees ? header.spacing : 0;
    spec.nx = static_cast<int>(header.nx);
    spec.ny = static_cast<int>(header.ny);
    spec.offset_x_cells = header.offset_x_cells;
    spec.offset_y_cells = header.offset_y_cells;
    spec.levels_m.resize(header.nz);
    std::memcpy(spec.levels_m.data(), levels.data(), levels.size());
    description.moment = static_cast<level2::Moment>(header.moment);
    description.time = time_of(header.time_ms);
    description.start_time = time_of(header.start_time_ms);
    description.end_time = time_of(header.end_time_ms);
    return description;
}

struct Metadata {
    FileHeader header;
    format::Layout at;
    std::vector<std::byte> bytes;
};

Result<Metadata> read_metadata(const Descriptor& file, std::uint64_t file_size,
                               std::uint64_t most_read_bytes) {
    Metadata metadata;
    if (file_size < format::page_size) {
        return fail(ErrorCode::truncated, "{} bytes: too short for a grid file", file_size);
    }
    metadata.bytes.resize(format::page_size);
    if (Status read = read_at(file, 0, metadata.bytes); !read) return pass_on(read);
    std::memcpy(&metadata.header, metadata.bytes.data(), sizeof metadata.header);
    if (Status known = check_identity(metadata.header); !known) return pass_on(known);
    const auto at = checked_layout(metadata.header);
    if (!at) return pass_on(at);
    metadata.at = *at;
    if (at->codes_offset > most_read_bytes) {
        return fail(ErrorCode::unsupported,
                    "{} bytes of it would be read into memory, more than {}", at->codes_offset,
                    most_read_bytes);
    }
    if (Status whole = check_size(file_size, at->file_size); !whole) return pass_on(whole);

    metadata.bytes.resize(at->codes_offset);
    const auto rest = std::span(metadata.bytes).subspan(format::page_size);
    if (Status read = read_at(file, format::page_size, rest); !read) return pass_on(read);
    if (Status right = check_checksum(metadata.bytes, metadata.header.checksum); !right) {
        return pass_on(right);
    }
    return metadata;
}

Result<GridDescription> described_by(const Metadata& metadata) {
    const format::Layout& at = metadata.at;
    const std::span<const std::byte> bytes(metadata.bytes);
    GridDescription description = description_of(
        metadata.header, bytes.subspan(at.levels_offset, at.description_offset - at.levels_offset));
    const Status good = decode_description(
        bytes.subspan(at.description_offset, metadata.header.description_size), description);
    if (!good) return pass_on(good);
    return description;
}

grid::BrickView view_of(const Metadata& metadata) {
    const FileHeader& header = metadata.header;
    const format::Layout& at = metadata.at;
    grid::BrickView view;
    view.quantization = {static_cast<int>(header.code_bytes), header.first_value, header.step,
                         level2::facts_of(static_cast<level2::Moment>(header.moment)).is_derived};
    view.bricks_x = static_cast<int>(header.bricks_x);
    view.bricks_y = static_cast<int>(header.bricks_y);
    view.bricks_z = static_cast<int>(header.bricks_z);
    // The entries are aligned, because operator new returned the memory, and the table's offset in
    // it is a multiple of 8.
    view.bricks = {reinterpret_cast<const BrickEntry*>(metadata.bytes.data() + at.table_offset),
                   (at.states_offset - at.table_offset) / sizeof(BrickEntry)};
    view.states =
        std::span<const std::byte>(metadata.bytes).subspan(at.states_offset, header.states_size);
    return view;
}

// The codes that a view shows, and the owner of their memory.
struct Codes {
    std::optional<Map> map;
    SparseMemory unpacked;
    std::span<const std::byte> view;
};

// Unpacks each stored brick into its place and compares it with the checksum in its entry. Only one
// stretch of packed bricks is in memory at a time.
Status unpack_all(const Descriptor& file, std::uint64_t offset, const grid::BrickView& view,
                  std::span<std::byte> places) {
    constexpr std::size_t stretch_bytes = std::size_t{1} << 20;
    const std::size_t brick_bytes =
        grid::brick_cells * static_cast<std::size_t>(view.quantization.code_bytes);
    std::vector<std::byte> stretch;
    std::span<const std::byte> packed;
    std::size_t read_until = 0;  // the first brick after the stretch
    const auto read_stretch = [&](std::size_t first) -> Status {
        std::size_t bytes = 0;
        for (read_until = first; read_until < view.bricks.size(); ++read_until) {
            const BrickEntry& entry = view.bricks[read_until];
            if (entry.kind != grid::BrickKind::stored) continue;
            if (bytes > 0 && bytes + entry.packed_bytes > stretch_bytes) break;
            bytes += entry.packed_bytes;
        }
        stretch.resize(bytes);
        packed = stretch;
        offset += bytes;
        return read_at(file, offset - bytes, stretch);
    };
    for (std::size_t i = 0; i < view.bricks.size(); ++i) {
        const BrickEntry& entry = view.bricks[i];
        if (entry.kind != grid::BrickKind::stored) continue;
        if (i >= read_until) {
            if (Status read = read_stretch(i); !read) return read;
        }
        const auto place = places.subspan(i * brick_bytes, brick_bytes);
        Status unpacked = unpack_brick(packed.first(entry.packed_bytes), place);
        if (unpacked && xxh3_64(place) != entry.checksum) {
            unpacked = fail(ErrorCode::corrupt, "brick {} has a wrong checksum", i);
        }
        if (!unpacked) return unpacked;
        packed = packed.subspan(entry.packed_bytes);
    }
    return {};
}

std::uint64_t unpacked_bytes(const grid::BrickView& view) {
    const auto stored = static_cast<std::uint64_t>(
        std::ranges::count(view.bricks, grid::BrickKind::stored, &BrickEntry::kind));
    return stored * grid::brick_cells * static_cast<std::uint64_t>(view.quantization.code_bytes);
}

Result<Codes> codes_of(const Descriptor& file, const Metadata& metadata,
                       const grid::BrickView& view, std::uint64_t most_unpacked_bytes) {
    const format::Layout& at = metadata.at;
    Codes codes;
    if (!is_packed(metadata.header)) {
        Result<Map> map = Map::of(file, at.file_size);
        if (!map) return pass_on(map);
        codes.view = map->bytes().subspan(at.codes_offset, at.codes_size);
        codes.map.emplace(std::move(*map));
        return codes;
    }
    if (packed_size(view.bricks) != at.codes_size) {
        return fail(ErrorCode::corrupt, "table and header differ in the size of the codes");
    }
    if (const std::uint64_t bytes = unpacked_bytes(view); bytes > most_unpacked_bytes) {
        return fail(ErrorCode::unsupported, "its codes unpack to {} bytes, more than {}", bytes,
                    most_unpacked_bytes);
    }
    Result<SparseMemory> places =
        SparseMemory::of(view.bricks.size() * grid::brick_cells *
                         static_cast<std::uint64_t>(view.quantization.code_bytes));
    if (!places) return pass_on(places);
    const Status all = unpack_all(file, at.codes_offset, view, places->bytes());
    if (!all) return pass_on(all);
    codes.view = places->bytes();
    return Codes{std::nullopt, std::move(*places), codes.view};
}

}  // namespace

Result<GridFile> GridFile::open(const std::filesystem::path& path, const GridFileLimits& limits) {
    const auto failure = [&](const Error& error) { return with_path(path, error); };
    Result<Descriptor> file = open_for_reading(path);
    if (!file) return failure(file.error());
    const Result<struct stat> facts = facts_of(*file);
    if (!facts) return failure(facts.error());
    Result<Metadata> metadata =
        read_metadata(*file, static_cast<std::uint64_t>(facts->st_size), limits.read_bytes);
    if (!metadata) return failure(metadata.error());

    Result<GridDescription> description = described_by(*metadata);
    if (!description) return failure(description.error());
    grid::BrickView view = view_of(*metadata);
    const Packing packing = is_packed(metadata->header) ? Packing::lz4 : Packing::none;
    Status good = check_description(*description, view.quantization);
    if (good) good = check_bricks(view.bricks, view.states, view.quantization, packing);
    if (!good) return failure(good.error());
    auto codes = codes_of(*file, *metadata, view, limits.unpacked_bytes);
    if (!codes) return failure(codes.error());
    view.codes = codes->view;

    auto mapping = std::make_unique<Mapping>(
        Mapping{path, std::move(*file), std::move(metadata->bytes), std::move(codes->map),
                std::move(codes->unpacked), metadata->at,
                static_cast<std::uint64_t>(facts->st_blocks) * 512, metadata->header.checksum,
                std::move(*description), view});
    mapping->view.spec = &mapping->description.spec;
    return GridFile(std::move(mapping));
}

Result<GridFacts> read_grid_facts(const Descriptor& file) {
    const Result<struct stat> facts = facts_of(file);
    if (!facts) return pass_on(facts);
    const auto metadata = read_metadata(file, static_cast<std::uint64_t>(facts->st_size),
                                        GridFileLimits{}.read_bytes);
    if (!metadata) return pass_on(metadata);
    Result<GridDescription> description = described_by(*metadata);
    if (!description) return pass_on(description);
    const Status good = check_description(*description, view_of(*metadata).quantization);
    if (!good) return pass_on(good);
    return GridFacts{std::move(*description), metadata->header.checksum};
}

GridFile::GridFile(std::unique_ptr<Mapping> mapping) : mapping_(std::move(mapping)) {}
GridFile::GridFile(GridFile&&) noexcept = default;
GridFile& GridFile::operator=(GridFile&&) noexcept = default;
GridFile::~GridFile() = default;

const GridDescription& GridFile::description() const {
    return mapping_->description;
}

grid::BrickView GridFile::view() const {
    return mapping_->view;
}

Packing GridFile::packing() const {
    return mapping_->map ? Packing::none : Packing::lz4;
}

std::uint64_t GridFile::bytes_on_disk() const {
    return mapping_->bytes_on_disk;
}

std::uint64_t GridFile::bytes() const {
    return mapping_->at.file_size;
}

std::uint64_t GridFile::checksum() const {
    return mapping_->checksum;
}

Result<Descriptor> GridFile::duplicate_descriptor() const {
    Descriptor copy(::fcntl(mapping_->file.number(), F_DUPFD_CLOEXEC, 0));
    if (!copy.is_open()) {
        return with_path(mapping_->path,
                         Error{ErrorCode::exhausted, std::system_category().message(errno)});
    }
    return copy;
}

}  // namespace stormcellar::cache

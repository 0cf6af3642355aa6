// Checks that an open grid file has not changed since it was written. Reads through the descriptor
// and never through the map, so a file that was cut in the meantime gives an error and not a
// signal.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>
#include <vector>

#include <unistd.h>

#include "base/checksum.h"
#include "cache/check.h"
#include "cache/grid_file_mapping.h"
#include "stormcellar/cache/grid_file.h"

namespace stormcellar::cache {

using grid::BrickEntry;
using grid::BrickKind;

Status GridFile::check_whole() const {
    Status whole = mapping_->check_map();
    if (!whole) return with_path(mapping_->path, whole.error());
    return {};
}

Status GridFile::verify() const {
    Status good = mapping_->check_map();
    if (good) good = mapping_->check_metadata();
    if (good) good = mapping_->check_stored_bricks();
    if (good && mapping_->map) good = mapping_->check_holes();
    if (!good) return with_path(mapping_->path, good.error());
    return {};
}

// A file that was cut and then extended to its old size has changed as well: its map shows zeros.
Status GridFile::Mapping::check_map() const {
    if (Status same = check_unchanged_size(); !same) return same;
    if (!map || !map->was_cut()) return {};
    return fail(ErrorCode::truncated, "was cut, or could not be read, while it was in use");
}

Status GridFile::Mapping::check_unchanged_size() const {
    const Result<struct stat> facts = facts_of(file);
    if (!facts) return pass_on(facts);
    return check_size(static_cast<std::uint64_t>(facts->st_size), at.file_size);
}

// If the metadata changed on disk after they were read, they are damaged, although they cannot
// mislead this reader.
Status GridFile::Mapping::check_metadata() const {
    std::vector<std::byte> bytes(metadata.size());
    if (Status read = read_at(file, 0, bytes); !read) return read;
    const auto field = std::span(bytes).subspan(offsetof(format::FileHeader, checksum), 8);
    std::uint64_t written = 0;
    std::memcpy(&written, field.data(), sizeof written);
    std::fill(field.begin(), field.end(), std::byte{0});
    if (bytes != metadata || written != xxh3_64(metadata)) {
        return fail(ErrorCode::corrupt, "header, table or states were altered");
    }
    for (const BrickEntry& entry : view.bricks) {
        if (entry.kind != BrickKind::status_only) continue;
        const auto block = view.states.subspan(entry.status_index * format::status_block_bytes,
                                               format::status_block_bytes);
        if (xxh3_64(block) != entry.checksum) {
            return fail(ErrorCode::corrupt, "the states {} have a wrong checksum",
                        entry.status_index);
        }
    }
    return {};
}

Status GridFile::Mapping::read_brick(std::size_t brick, std::uint64_t& offset,
                                     std::span<std::byte> codes) const {
    if (map) return read_at(file, at.codes_offset + brick * codes.size(), codes);
    std::vector<std::byte> packed(view.bricks[brick].packed_bytes);
    if (Status read = read_at(file, offset, packed); !read) return read;
    offset += packed.size();
    return unpack_brick(packed, codes);
}

Status GridFile::Mapping::check_stored_bricks() const {
    std::vector<std::byte> codes(brick_bytes());
    std::uint64_t offset = at.codes_offset;  // of the next packed codes
    std::uint64_t stored = 0;
    std::uint64_t damaged = 0;
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < view.bricks.size(); ++i) {
        const BrickEntry& entry = view.bricks[i];
        if (entry.kind != BrickKind::stored) continue;
        ++stored;
        Status read = read_brick(i, offset, codes);
        if (!read && read.error().code != ErrorCode::corrupt) return read;
        const CodeRange expected{entry.value_count, entry.min_code, entry.max_code};
        if (read && xxh3_64(codes) == entry.checksum &&
            code_range(codes, view.quantization.code_bytes) == expected) {
            continue;
        }
        ++damaged;
        if (!first) first = i;
    }
    if (damaged == 0) return {};
    return fail(ErrorCode::corrupt, "{} of {} stored bricks are damaged, the first is brick {}",
                damaged, stored, *first);
}

// Checks that the places of absent bricks read as zeros.
Status GridFile::Mapping::check_holes() const {
    const auto is_stored = [&](std::size_t i) { return view.bricks[i].kind == BrickKind::stored; };
    for (std::size_t begin = 0; begin < view.bricks.size();) {
        if (is_stored(begin)) {
            ++begin;
            continue;
        }
        std::size_t end = begin + 1;
        while (end < view.bricks.size() && !is_stored(end))
            ++end;
        Status zeros = check_zeros(at.codes_offset + begin * brick_bytes(),
                                   at.codes_offset + end * brick_bytes());
        if (!zeros) return zeros;
        begin = end;
    }
    return {};
}

Status GridFile::Mapping::check_zeros(std::uint64_t begin, std::uint64_t end) const {
    std::array<std::byte, format::page_size> page{};
    while (begin < end) {
        // Holes are skipped without being read. If the file system cannot find holes, it reports
        // everything as data.
        const off_t data = ::lseek(file.number(), static_cast<off_t>(begin), SEEK_DATA);
        if (data < 0 && errno == ENXIO) return {};
        if (data >= 0 && static_cast<std::uint64_t>(data) >= end) return {};
        if (data >= 0) begin = std::max(begin, static_cast<std::uint64_t>(data));
        const auto part = std::span(page).first(std::min<std::uint64_t>(page.size(), end - begin));
        if (Status read = read_at(file, begin, part); !read) return read;
        if (std::any_of(part.begin(), part.end(), [](std::byte b) { return b != std::byte{0}; })) {
            return fail(ErrorCode::corrupt, "there are bytes at {}, where no brick is stored",
                        begin);
        }
        begin += part.size();
    }
    return {};
}

}  // namespace stormcellar::cache

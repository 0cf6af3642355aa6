// Mutates grid files. Everything before the codes has one checksum, and each brick has its own, so
// nearly every mutation needs new checksums to pass the checks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/checksum.h"
#include "cache/format.h"
#include "cache/packing.h"
#include "tests/fuzz/mutators.h"

namespace stormcellar::fuzz {
namespace {

namespace format = cache::format;
using format::FileHeader;
using grid::BrickEntry;
using grid::BrickKind;

// The sections that the header gives, limited to the size of the file.
struct Sections {
    FileHeader header;
    std::size_t table = 0, states = 0, codes = 0;
    std::size_t bricks = 0, brick_bytes = 0;
};

Sections sections_of(const Bytes& file) {
    Sections sections;
    std::memcpy(&sections.header, file.data(), sizeof sections.header);
    const auto within = [&](std::uint64_t offset) {
        return static_cast<std::size_t>(std::min<std::uint64_t>(offset, file.size()));
    };
    sections.table = within(sections.header.table_offset);
    sections.states = std::max(sections.table, within(sections.header.states_offset));
    sections.codes = std::max(sections.states, within(sections.header.codes_offset));
    sections.bricks = (sections.states - sections.table) / sizeof(BrickEntry);
    sections.brick_bytes = grid::brick_cells * (sections.header.code_bytes == 2 ? 2 : 1);
    return sections;
}

BrickEntry entry_of(const Bytes& file, const Sections& sections, std::size_t brick) {
    BrickEntry entry;
    std::memcpy(static_cast<void*>(&entry),
                file.data() + sections.table + brick * sizeof(BrickEntry), sizeof entry);
    return entry;
}

void set_entry(Bytes& file, const Sections& sections, std::size_t brick, const BrickEntry& entry) {
    std::memcpy(file.data() + sections.table + brick * sizeof(BrickEntry), &entry, sizeof entry);
}

// Returns the unpacked codes of a brick, or no bytes if the file does not hold them.
Bytes codes_of(const Bytes& file, const Sections& sections, std::size_t brick) {
    std::size_t begin = sections.codes + brick * sections.brick_bytes;
    std::size_t size = sections.brick_bytes;
    const bool packed = sections.header.required_features == format::packed_codes;
    if (packed) {
        begin = sections.codes;
        for (std::size_t i = 0; i < brick; ++i)
            begin += entry_of(file, sections, i).packed_bytes;
        size = entry_of(file, sections, brick).packed_bytes;
    }
    if (begin > file.size() || size > file.size() - begin) return {};
    const auto first = file.begin() + static_cast<std::ptrdiff_t>(begin);
    Bytes codes(first, first + static_cast<std::ptrdiff_t>(size));
    if (!packed) return codes;
    Bytes unpacked(sections.brick_bytes);
    return cache::unpack_brick(codes, unpacked) ? unpacked : Bytes{};
}

// Sets the count, extremes and checksum in `entry` to those of the codes that the brick has now.
void seal_codes(const Bytes& file, const Sections& sections, std::size_t brick, BrickEntry& entry) {
    const Bytes codes = codes_of(file, sections, brick);
    if (codes.empty()) return;
    entry.checksum = xxh3_64(codes);
    const std::size_t width = sections.brick_bytes / grid::brick_cells;
    entry.value_count = entry.max_code = 0;
    entry.min_code = 0xFFFF;
    for (std::size_t at = 0; at < codes.size(); at += width) {
        const unsigned high = width == 2 ? std::to_integer<unsigned>(codes[at + 1]) : 0;
        const auto code =
            static_cast<std::uint16_t>(std::to_integer<unsigned>(codes[at]) + 256 * high);
        if (code < grid::first_value_code) continue;
        ++entry.value_count;
        entry.min_code = std::min(entry.min_code, code);
        entry.max_code = std::max(entry.max_code, code);
    }
}

void seal_states(const Bytes& file, const Sections& sections, BrickEntry& entry) {
    const std::size_t begin = sections.states + entry.status_index * format::status_block_bytes;
    if (begin + format::status_block_bytes > sections.codes) return;
    entry.checksum = xxh3_64(std::span(file).subspan(begin, format::status_block_bytes));
}

void seal_bricks(Bytes& file) {
    const Sections sections = sections_of(file);
    for (std::size_t i = 0; i < sections.bricks; ++i) {
        BrickEntry entry = entry_of(file, sections, i);
        if (entry.kind == BrickKind::stored) seal_codes(file, sections, i, entry);
        if (entry.kind == BrickKind::status_only) seal_states(file, sections, entry);
        set_entry(file, sections, i, entry);
    }
}

void seal_header(Bytes& file) {
    const std::size_t end = sections_of(file).codes;
    if (end < sizeof(FileHeader)) return;
    const auto field =
        std::span(file).subspan(offsetof(FileHeader, checksum), sizeof(std::uint64_t));
    std::fill(field.begin(), field.end(), std::byte{0});
    const std::uint64_t checksum = xxh3_64(std::span(file).first(end));
    std::memcpy(field.data(), &checksum, sizeof checksum);
}

template <class T>
void put(Bytes& file, std::size_t at, T number) {
    if (at + sizeof number <= file.size()) std::memcpy(file.data() + at, &number, sizeof number);
}

// Sets a field of the header to an extreme value, or to a value close to its old value.
void set_header_field(Bytes& file, Random& random) {
    constexpr std::array<std::uint64_t, 12> extremes = {
        0, 1, 2, 3, 4096, 16384, 1 << 20, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, ~0ULL >> 1, ~0ULL};
    const std::size_t at = 4 * below(random, sizeof(FileHeader) / 4);
    const bool wide = below(random, 2) == 0;
    std::uint64_t number = extremes[below(random, extremes.size())];
    if (below(random, 2) == 0) {
        std::memcpy(&number, file.data() + at, wide && at + 8 <= sizeof(FileHeader) ? 8 : 4);
        number += below(random, 2) == 0 ? 1 : ~0ULL;
    }
    if (wide) {
        put(file, at, number);
    } else {
        put(file, at, static_cast<std::uint32_t>(number));
    }
}

void set_number(Bytes& file, Random& random) {
    constexpr std::array<double, 8> numbers = {
        0, -0.0, 1e-300, 1e300, 90.0, 500, -180, std::numeric_limits<double>::infinity()};
    const double number = below(random, 9) == 0 ? std::nan("") : numbers[below(random, 8)];
    const Sections sections = sections_of(file);
    const std::size_t levels = format::page_size + 8 * below(random, sections.header.nz % 1024);
    constexpr std::array<std::size_t, 3> fields = {120, 128, 136};
    if (below(random, 3) == 0) {
        put(file, 152 + 4 * below(random, 2), static_cast<float>(number));
    } else {
        put(file, below(random, 2) == 0 ? levels : fields[below(random, 3)], number);
    }
}

void change_entry(Bytes& file, Random& random) {
    const Sections sections = sections_of(file);
    if (sections.bricks == 0) return;
    const std::size_t brick = below(random, sections.bricks);
    BrickEntry entry = entry_of(file, sections, brick);
    const auto number = static_cast<std::uint16_t>(
        below(random, 2) == 0 ? below(random, 5) : 0xFFFF - below(random, 0xF001));
    const std::size_t field = below(random, 8);
    if (field == 0) entry.kind = static_cast<BrickKind>(below(random, 4));
    if (field == 1) entry.uniform_status = static_cast<grid::CellStatus>(below(random, 5));
    if (field == 2) entry.value_count = number;
    if (field == 3) entry.min_code = number;
    if (field == 4) entry.max_code = number;
    if (field == 5) entry.status_index = number;
    if (field == 6) entry.packed_bytes = number;
    if (field == 7) entry = entry_of(file, sections, below(random, sections.bricks));
    set_entry(file, sections, brick, entry);
}

// Gives a record of the description another kind or length.
void change_record(Bytes& file, Random& random) {
    const Sections sections = sections_of(file);
    const auto description = static_cast<std::size_t>(
        std::min<std::uint64_t>(sections.header.description_offset, file.size()));
    const std::size_t size = sections.table - std::min(sections.table, description);
    const std::size_t at = description + 8 * below(random, size / 8 + 1);
    if (below(random, 2) == 0) {
        put(file, at, static_cast<std::uint16_t>(below(random, 17)));
    } else {
        constexpr std::array<std::uint32_t, 8> lengths = {0,  4,       8,          16,
                                                          24, 1 << 20, 0xFFFFFFF8, 0xFFFFFFFF};
        put(file, at + 4, lengths[below(random, 8)]);
    }
}

// Mutates the bytes of one section with `mutate`; the section keeps its size.
void change_section(Bytes& file, std::size_t begin, std::size_t end, const MutateBytes& mutate) {
    if (begin >= end) return;
    const auto first = file.begin() + static_cast<std::ptrdiff_t>(begin);
    Bytes part(first, file.begin() + static_cast<std::ptrdiff_t>(end));
    part = mutate(part, part.size());
    part.resize(end - begin);
    std::copy(part.begin(), part.end(), first);
}

void change_size(Bytes& file, std::size_t most, Random& random) {
    const std::size_t pages = below(random, most / format::page_size + 1) * format::page_size;
    file.resize(below(random, 2) == 0 ? pages : below(random, file.size() + 1));
    if (file.size() >= sizeof(FileHeader) && below(random, 2) == 0) {
        put(file, offsetof(FileHeader, file_size), static_cast<std::uint64_t>(file.size()));
    }
}

}  // namespace

Bytes mutate_grid_file(const Bytes& file, std::size_t most, Random& random,
                       const MutateBytes& mutate) {
    if (file.size() < sizeof(FileHeader) || file.size() > most || below(random, 16) == 0) {
        return mutate(file, most);
    }
    Bytes changed = file;
    const Sections sections = sections_of(file);
    const std::size_t kind = below(random, 9);
    if (kind == 0) set_header_field(changed, random);
    if (kind == 1) set_number(changed, random);
    if (kind == 2 || kind == 3) change_entry(changed, random);
    if (kind == 4) change_record(changed, random);
    if (kind == 5) change_section(changed, sizeof(FileHeader), sections.table, mutate);
    if (kind == 6) change_section(changed, sections.states, sections.codes, mutate);
    if (kind == 7) change_section(changed, sections.codes, changed.size(), mutate);
    if (kind == 8) change_size(changed, most, random);
    if (changed.size() < sizeof(FileHeader)) return changed;
    if (below(random, 4) != 0) seal_bricks(changed);
    if (below(random, 16) != 0) seal_header(changed);
    return changed;
}

}  // namespace stormcellar::fuzz

#include "render/still/zip_file.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "base/checksum.h"

namespace stormcellar::render {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are");

template <class Number>
void append_number(std::vector<std::byte>& to, Number number) {
    const auto bytes = std::bit_cast<std::array<std::byte, sizeof number>>(number);
    to.insert(to.end(), bytes.begin(), bytes.end());
}

void append_text(std::vector<std::byte>& to, const std::string& text) {
    for (const char c : text)
        to.push_back(static_cast<std::byte>(c));
}

constexpr std::uint16_t needed_version = 20;
constexpr std::uint16_t first_day = 0x21;  // 1980-01-01, the earliest date that a zip can hold

// Appends the fields that are in both a member's own header and its entry in the directory.
void append_member(std::vector<std::byte>& to, const ZipMember& member) {
    const auto size = static_cast<std::uint32_t>(member.bytes.size());
    append_number(to, needed_version);
    append_number(to, std::uint16_t{0});  // flags
    append_number(to, std::uint16_t{0});  // stored
    append_number(to, std::uint16_t{0});  // time of day
    append_number(to, first_day);
    append_number(to, crc32(member.bytes));
    append_number(to, size);
    append_number(to, size);
    append_number(to, static_cast<std::uint16_t>(member.name.size()));
    append_number(to, std::uint16_t{0});  // extra field
}

}  // namespace

Result<std::vector<std::byte>> write_zip(const std::vector<ZipMember>& members) {
    constexpr std::uint32_t member_mark = 0x04034b50, entry_mark = 0x02014b50,
                            end_mark = 0x06054b50;
    constexpr std::size_t most_bytes = std::numeric_limits<std::uint32_t>::max() / 2;
    std::size_t total = 0;
    for (const ZipMember& member : members)
        total += member.bytes.size() + 2 * member.name.size() + 128;
    if (total > most_bytes || members.size() >= std::numeric_limits<std::uint16_t>::max()) {
        return fail(ErrorCode::unsupported, "zip: {} bytes are too many", total);
    }
    std::vector<std::byte> file;
    std::vector<std::byte> directory;
    for (const ZipMember& member : members) {
        append_number(directory, entry_mark);
        append_number(directory, needed_version);  // made by
        append_member(directory, member);
        append_number(directory, std::uint16_t{0});  // comment
        append_number(directory, std::uint16_t{0});  // disk
        append_number(directory, std::uint16_t{0});  // internal attributes
        append_number(directory, std::uint32_t{0});  // external attributes
        append_number(directory, static_cast<std::uint32_t>(file.size()));
        append_text(directory, member.name);
        append_number(file, member_mark);
        append_member(file, member);
        append_text(file, member.name);
        file.insert(file.end(), member.bytes.begin(), member.bytes.end());
    }
    const auto start = static_cast<std::uint32_t>(file.size());
    file.insert(file.end(), directory.begin(), directory.end());
    append_number(file, end_mark);
    append_number(file, std::uint32_t{0});  // disks
    append_number(file, static_cast<std::uint16_t>(members.size()));
    append_number(file, static_cast<std::uint16_t>(members.size()));
    append_number(file, static_cast<std::uint32_t>(directory.size()));
    append_number(file, start);
    append_number(file, std::uint16_t{0});  // comment
    return file;
}

}  // namespace stormcellar::render

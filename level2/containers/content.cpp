#include "level2/containers/content.h"

#include <algorithm>
#include <array>

#include "level2/containers/archive_header.h"
#include "level2/containers/bzip2_stream.h"
#include "level2/containers/compress_stream.h"
#include "level2/containers/gzip_stream.h"
#include "level2/containers/ldm_framer.h"
#include "level2/messages/message_header.h"

namespace stormcellar::level2 {
namespace {

bool plausible_at(std::span<const std::byte> bytes, std::size_t at) {
    if (bytes.size() < at + message_header_bytes) return false;
    const auto header_bytes = bytes.subspan(at, message_header_bytes);
    return !all_zero(header_bytes) && is_plausible(read_message_header(header_bytes));
}

bool messages_at_start(std::span<const std::byte> bytes, bool after_header) {
    if (is_surely_message(bytes)) return true;
    const bool first = plausible_at(bytes, 0);
    if (after_header && first) return true;
    // Two plausible headers one frame apart cannot be chance, and neither can one sure message.
    if (bytes.size() < frame_bytes) return false;
    return is_surely_message(bytes.subspan(frame_bytes)) ||
           (first && plausible_at(bytes, frame_bytes));
}

template <class... Values>
bool begins_with(std::span<const std::byte> bytes, Values... values) {
    const std::array start{static_cast<std::byte>(values)...};
    return bytes.size() >= start.size() && std::ranges::equal(bytes.first(start.size()), start);
}

// Returns true for PNG, HDF5 and grid files, which begin with 89h, three letters and line ends, and
// for xz and zstd. If something inside such a file looks like a message or a record, that is
// chance.
bool is_of_another_format(std::span<const std::byte> bytes) {
    if (begins_with(bytes, 0xFD, 0x37, 0x7A, 0x58, 0x5A, 0x00)) return true;
    if (begins_with(bytes, 0x28, 0xB5, 0x2F, 0xFD)) return true;
    constexpr auto line_ends = std::to_array<std::byte>(
        {std::byte{0x0D}, std::byte{0x0A}, std::byte{0x1A}, std::byte{0x0A}});
    return bytes.size() >= 8 && bytes[0] == std::byte{0x89} &&
           std::ranges::equal(bytes.subspan(4, line_ends.size()), line_ends);
}

}  // namespace

Content content_at_start(std::span<const std::byte> bytes) {
    if (is_gzip(bytes)) return Content::gzip;
    if (is_compress(bytes)) return Content::compress;
    if (is_bzip2(bytes)) return Content::bzip2;
    const bool header = read_archive_header(bytes).has_value();
    const auto rest = bytes.subspan(header ? archive_header_bytes : 0);
    if (is_ldm_record(rest)) return Content::ldm;
    if (messages_at_start(rest, header)) return Content::messages;
    return Content::unknown;
}

Content content_anywhere(std::span<const std::byte> bytes) {
    if (is_of_another_format(bytes)) return Content::unknown;
    const Content content = content_at_start(bytes);
    if (content != Content::unknown) return content;
    if (find_bzip2(bytes, 0)) return Content::ldm;
    if (find_message(bytes, 0)) return Content::messages;
    return Content::unknown;
}

}  // namespace stormcellar::level2

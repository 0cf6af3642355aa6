#include "archive/archive_format.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <utility>

#include <archive.h>
#include <archive_entry.h>

namespace stormcellar::archive {
namespace {

// Returns true if the checksum shows that the bytes are a tar header. The checksum is the sum of
// all bytes of the header, with blanks in place of the checksum itself.
bool is_tar_header(std::span<const std::byte> bytes) {
    constexpr std::size_t sum_at = 148;
    constexpr std::size_t sum_bytes = 8;
    if (bytes.size() < tar_block_bytes || bytes[0] == std::byte{0}) return false;
    std::uint32_t sum = 0;
    std::uint32_t claimed = 0;
    for (std::size_t i = 0; i < tar_block_bytes; ++i) {
        const bool is_sum = i >= sum_at && i < sum_at + sum_bytes;
        sum += is_sum ? ' ' : std::to_integer<std::uint32_t>(bytes[i]);
        const char c = std::to_integer<char>(bytes[i]);
        if (is_sum && c >= '0' && c <= '7') claimed = 8 * claimed + static_cast<unsigned>(c - '0');
    }
    return claimed == sum;
}

int format_of(::archive* handle) {
    return archive_format(handle) & ARCHIVE_FORMAT_BASE_MASK;
}

}  // namespace

bool begins_with(std::span<const std::byte> bytes, std::string_view text) {
    return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

bool may_be_archive(std::span<const std::byte> start) {
    return begins_with(start, "PK\x03\x04") || begins_with(start, "PK\x05\x06") ||
           is_tar_header(start) || is_packed(start);
}

Handle new_reader() {
    Handle handle{archive_read_new()};
    const auto support = [&](auto function) { return function(handle.get()) >= ARCHIVE_WARN; };
    const bool formats =
        support(archive_read_support_format_tar) && support(archive_read_support_format_zip);
    // Read on after blocks of zeros, because they may be a lost page of the file, or the end of one
    // of several joined tars.
    const bool goes_on =
        archive_read_set_format_option(handle.get(), "tar", "read_concatenated_archives", "1") >=
        ARCHIVE_WARN;
    return formats && goes_on ? std::move(handle) : Handle{};
}

bool is_zip(::archive* handle) {
    return format_of(handle) == ARCHIVE_FORMAT_ZIP;
}

bool is_tar(::archive* handle) {
    return format_of(handle) == ARCHIVE_FORMAT_TAR;
}

bool is_small_codec(::archive* handle) {
    const char* const text = archive_format_name(handle);
    const std::string_view name = text == nullptr ? std::string_view{} : std::string_view{text};
    return !is_zip(handle) || name.find("deflation") != std::string_view::npos ||
           name.find("uncompressed") != std::string_view::npos;
}

std::uint64_t place_of(::archive* handle) {
    return static_cast<std::uint64_t>(std::max<la_int64_t>(0, archive_filter_bytes(handle, 0)));
}

std::string name_of(::archive_entry* entry) {
    const char* name = archive_entry_pathname_utf8(entry);
    if (name == nullptr) name = archive_entry_pathname(entry);
    return name == nullptr ? std::string{} : std::string{name};
}

std::string_view refusal_of(::archive_entry* entry, const std::string& name) {
    if (archive_entry_hardlink(entry) != nullptr || archive_entry_symlink(entry) != nullptr) {
        return "is a link";
    }
    if (archive_entry_filetype(entry) != AE_IFREG) return "is not a regular file";
    // libarchive would write out the holes of a sparse file. Radar data are not packed as sparse
    // files.
    if (archive_entry_sparse_count(entry) > 0) return "is a sparse file";
    if (name.empty()) return "has no name";
    if (name.size() > most_name_bytes) return "has a name of more than 1024 bytes";
    const std::filesystem::path path{name};
    const bool leads_out = path.is_absolute() || std::ranges::find(path, "..") != path.end();
    return leads_out ? "names a place outside the archive" : "";
}

std::optional<UtcTime> time_of(::archive_entry* entry) {
    if (archive_entry_mtime_is_set(entry) == 0) return std::nullopt;
    return UtcTime{
        std::chrono::seconds{std::clamp<la_int64_t>(archive_entry_mtime(entry), 0, 7'000'000'000)}};
}

std::uint64_t claimed_bytes_of(::archive_entry* entry) {
    if (archive_entry_size_is_set(entry) == 0) return 0;
    return static_cast<std::uint64_t>(std::max<la_int64_t>(0, archive_entry_size(entry)));
}

}  // namespace stormcellar::archive

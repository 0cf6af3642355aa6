#include "archive/packed_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include <archive.h>
#include <archive_entry.h>

namespace stormcellar::archive {
namespace {

constexpr std::size_t unpacked_block_bytes = std::size_t{16} << 10;
// Most bytes of the source that a codec may read for one block of output.
constexpr std::uint64_t most_source_bytes = std::uint64_t{4} << 20;

struct Codec {
    std::string_view magic;
    int filter;
    bool is_small;
};
// libarchive has all these codecs built in, so it starts no other program.
using namespace std::string_view_literals;
constexpr std::array<Codec, 5> codecs = {{
    {"\x1F\x8B"sv, ARCHIVE_FILTER_GZIP, true},
    {"BZh"sv, ARCHIVE_FILTER_BZIP2, true},
    {"\x1F\x9D"sv, ARCHIVE_FILTER_COMPRESS, true},
    {"\xFD"
     "7zXZ"sv,
     ARCHIVE_FILTER_XZ, false},
    {"\x28\xB5\x2F\xFD"sv, ARCHIVE_FILTER_ZSTD, false},
}};

const Codec* codec_of(std::span<const std::byte> start) {
    const auto found = std::ranges::find_if(codecs, [&](const Codec& codec) {
        return start.size() >= codec.magic.size() &&
               std::memcmp(start.data(), codec.magic.data(), codec.magic.size()) == 0;
    });
    return found == codecs.end() ? nullptr : &*found;
}

// Returns true if a .Z file may unpack to another .Z file, judging by its first two codes of nine
// bits each. If the codes do not show the first two bytes, the result is true.
bool may_be_compressed_twice(std::span<const std::byte> start) {
    constexpr std::size_t codes_at = 3, bytes_of_two_codes = 3;
    constexpr unsigned nine_bits = 0x1FF, reset = 256;
    if (start.size() < codes_at + bytes_of_two_codes) return true;
    unsigned bits = 0;
    for (std::size_t i = bytes_of_two_codes; i-- > 0;)
        bits = bits << 8 | std::to_integer<unsigned>(start[codes_at + i]);
    const unsigned first = bits & nine_bits, second = bits >> 9 & nine_bits;
    return first >= reset || second == reset || (first == 0x1F && second == 0x9D);
}

// Opens a reader with exactly one filter. If libarchive chose the filters, it would look for
// further filters after the first, and nothing would count the bytes that this search unpacks. The
// filter of compress reads as soon as it is added, so it cannot be added before the source is set.
// So for compress alone, libarchive does choose the filter, with compress as the only choice.
// libarchive could then choose compress up to 25 times, which would take milliseconds for each byte
// of the outermost layer. So PackedStream::open() refuses files that may be compressed twice.
bool begin_reading(::archive* handle, int filter, const PackedStream::OpenSource& source) {
    const bool is_compress = filter == ARCHIVE_FILTER_COMPRESS;
    const int code = is_compress ? archive_read_support_filter_compress(handle)
                                 : archive_read_append_filter(handle, filter);
    constexpr int one_filter = 2;  // libarchive counts the source itself as one
    return code >= ARCHIVE_WARN && archive_read_support_format_raw(handle) >= ARCHIVE_WARN &&
           source(handle) && archive_filter_count(handle) == one_filter;
}

}  // namespace

bool is_packed(std::span<const std::byte> start) {
    return codec_of(start) != nullptr;
}

bool ReadBudget::take(::archive* handle, std::uint64_t bytes) {
    is_late_ = is_late_ || steady_now() > deadline_;
    if (is_late_) archive_set_error(handle, ETIMEDOUT, "it takes too long");
    if (is_late_ || !counts_) return !is_late_;
    is_spent_ = is_spent_ || bytes > left_;
    left_ -= std::min(left_, bytes);
    if (is_spent_) archive_set_error(handle, EFBIG, "a header is too long");
    return !is_spent_;
}

void ReadBudget::add(std::uint64_t bytes) {
    constexpr std::uint64_t usual_bytes = std::uint64_t{8} << 10;
    constexpr std::uint64_t most_long_bytes = std::uint64_t{4} << 20;
    long_bytes_ += bytes - std::min(bytes, usual_bytes);
    is_spent_ = is_spent_ || long_bytes_ > most_long_bytes;
}

void CloseArchive::operator()(::archive* archive) const {
    archive_read_free(archive);
}

std::string error_text_of(::archive* handle) {
    const char* text = archive_error_string(handle);
    return text == nullptr ? "it is damaged" : text;
}

PackedStream::PackedStream(Handle source, ReadBudget& of_source, Bound bound)
    : source_(std::move(source)),
      of_source_(of_source),
      bound_(std::move(bound)),
      block_(unpacked_block_bytes) {}

std::unique_ptr<PackedStream> PackedStream::open(std::span<const std::byte> start,
                                                 const OpenSource& source, ReadBudget& of_source,
                                                 bool small_codecs, Bound bound) {
    const Codec* const codec = codec_of(start);
    if (codec == nullptr || (small_codecs && !codec->is_small)) return nullptr;
    if (codec->filter == ARCHIVE_FILTER_COMPRESS && may_be_compressed_twice(start)) return nullptr;
    of_source.begin(most_source_bytes);
    Handle handle{archive_read_new()};
    if (!handle || !begin_reading(handle.get(), codec->filter, source)) return nullptr;
    ::archive_entry* whole = nullptr;
    if (archive_read_next_header(handle.get(), &whole) < ARCHIVE_WARN) return nullptr;
    return std::unique_ptr<PackedStream>(
        new PackedStream(std::move(handle), of_source, std::move(bound)));
}

bool PackedStream::feed(::archive* handle, ReadBudget& header) {
    header_ = &header;
    const auto read = [](::archive* reader, void* self, const void** bytes) -> la_ssize_t {
        return static_cast<PackedStream*>(self)->read_more(reader, bytes);
    };
    return archive_read_open(handle, this, nullptr, read, nullptr) == ARCHIVE_OK;
}

std::int64_t PackedStream::read_more(::archive* handle, const void** bytes) {
    of_source_.begin(most_source_bytes);
    const la_ssize_t got = archive_read_data(source_.get(), block_.data(), block_.size());
    if (got < 0) {
        archive_set_error(handle, EIO, "%s", error_text_of(source_.get()).c_str());
        return ARCHIVE_FATAL;
    }
    if (unpacked_ == 0 && got > 0) begins_with_zero_ = block_.front() == std::byte{0};
    unpacked_ += static_cast<std::uint64_t>(got);
    const auto source_bytes = static_cast<std::uint64_t>(
        std::max<la_int64_t>(0, archive_filter_bytes(source_.get(), -1)));
    if (const std::uint64_t most = bound_(source_bytes); unpacked_ > most) {
        met_bound_ = most;
        archive_set_error(handle, EFBIG, "it unpacks to too many bytes");
        return ARCHIVE_FATAL;
    }
    if (!header_->take(handle, static_cast<std::uint64_t>(got))) return ARCHIVE_FATAL;
    *bytes = block_.data();
    return got;
}

}  // namespace stormcellar::archive

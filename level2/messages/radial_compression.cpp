#include "level2/messages/radial_compression.h"

#include <algorithm>
#include <limits>

#include <zlib.h>

#include "base/byte_reader.h"
#include "bunzip/bunzip.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t compression_at = 16;
constexpr std::size_t length_at = 18;
constexpr std::size_t block_count_at = 30;
constexpr std::size_t pointers_at = 32;
constexpr int bzip2_indicator = 1;
constexpr int zlib_indicator = 2;

// Returns the size of the data header block, or 0 if the pointers are impossible.
std::size_t header_bytes(std::span<const std::byte> body) {
    ByteReader reader{body};
    reader.seek(block_count_at);
    const std::uint16_t blocks = reader.u16();
    std::size_t least = std::numeric_limits<std::size_t>::max();
    for (std::uint16_t i = 0; i < blocks && !reader.failed(); ++i) {
        const std::uint32_t pointer = reader.u32();
        if (pointer != 0) least = std::min<std::size_t>(least, pointer);
    }
    if (reader.failed() || least < pointers_at + std::size_t{4} * blocks || least > body.size()) {
        return 0;
    }
    return least;
}

// Inflates a zlib or gzip stream into `out`. Returns false unless it fills `out` exactly.
bool inflate_all(std::span<const std::byte> from, std::span<std::byte> out) {
    constexpr int zlib_or_gzip = 15 + 32;
    z_stream stream{};
    if (inflateInit2(&stream, zlib_or_gzip) != Z_OK) return false;
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(from.data()));
    stream.avail_in = static_cast<uInt>(from.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int code = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    return code == Z_STREAM_END && stream.avail_out == 0;
}

bool bunzip_all(std::span<const std::byte> from, std::span<std::byte> out) {
    static thread_local bunzip::Workspace workspace;  // empty if no radial uses bzip2
    bunzip::Reader reader{from, workspace};
    const std::size_t made = reader.read(out);
    std::byte surplus{};
    const bool is_longer = !reader.ended() && reader.read(std::span{&surplus, 1}) > 0;
    return made == out.size() && !is_longer && reader.ended() &&
           reader.status() == bunzip::Status::whole;
}

}  // namespace

int message_31_compression(std::span<const std::byte> body) {
    return body.size() > compression_at ? std::to_integer<int>(body[compression_at]) : 0;
}

tl::expected<std::vector<std::byte>, std::string_view> expand_message_31(
    std::span<const std::byte> body) {
    const auto no = [](std::string_view reason) { return tl::unexpected(reason); };
    const std::size_t header = header_bytes(body);
    if (header == 0) return no("the pointers of a compressed radial are impossible");
    ByteReader reader{body};
    reader.seek(length_at);
    const std::size_t length = reader.u16();
    if (length <= header) return no("the length of a compressed radial is impossible");
    std::vector<std::byte> whole(length);
    std::copy_n(body.begin(), header, whole.begin());
    const auto from = body.subspan(header);
    const auto out = std::span{whole}.subspan(header);
    const int compression = message_31_compression(body);
    if (compression != bzip2_indicator && compression != zlib_indicator) {
        return no("a radial is compressed in a way that no ICD has");
    }
    const bool good =
        compression == bzip2_indicator ? bunzip_all(from, out) : inflate_all(from, out);
    if (!good) return no("a compressed radial does not give what its header says");
    return whole;
}

}  // namespace stormcellar::level2

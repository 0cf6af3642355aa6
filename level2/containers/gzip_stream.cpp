#include "level2/containers/gzip_stream.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string_view>

#include "level2/messages/message_header.h"

namespace stormcellar::level2 {
namespace {

constexpr int gzip_window_bits = 15 + 16;  // the largest window, for gzip only

}  // namespace

bool is_gzip(std::span<const std::byte> bytes) {
    return bytes.size() >= 3 && bytes[0] == std::byte{0x1F} && bytes[1] == std::byte{0x8B} &&
           bytes[2] == std::byte{8};
}

GzipStream::GzipStream(std::span<const std::byte> bytes) : bytes_(bytes), output_(piece_bytes) {
    if (inflateInit2(&stream_, gzip_window_bits) != Z_OK) throw std::bad_alloc{};
}

GzipStream::~GzipStream() {
    inflateEnd(&stream_);
}

std::span<const std::byte> GzipStream::next() {
    std::size_t made = 0;
    while (end_ == GzipEnd::none && made < output_.size()) {
        if (stream_.avail_in == 0 && fed_ < bytes_.size()) {
            const std::size_t most = std::numeric_limits<uInt>::max();
            stream_.avail_in = static_cast<uInt>(std::min(bytes_.size() - fed_, most));
            // zlib does not write through next_in; its C interface merely lacks the const.
            stream_.next_in =
                const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes_.data() + fed_));
            fed_ += stream_.avail_in;
        }
        const std::size_t room = output_.size() - made;
        stream_.next_out = reinterpret_cast<Bytef*>(output_.data() + made);
        stream_.avail_out = static_cast<uInt>(room);
        const int code = inflate(&stream_, Z_NO_FLUSH);
        made += room - stream_.avail_out;
        if (code == Z_OK) continue;
        if (code == Z_STREAM_END && next_member()) continue;
        if (end_ == GzipEnd::none) end_ = end_of(code);
    }
    return std::span{output_}.first(made);
}

bool GzipStream::next_member() {
    const auto rest = bytes_.subspan(position());
    if (is_gzip(rest)) return inflateReset(&stream_) == Z_OK;
    // Archives pad files with zeros.
    end_ = all_zero(rest) ? GzipEnd::whole : GzipEnd::trailing_garbage;
    return false;
}

GzipEnd GzipStream::end_of(int code) const {
    if (code == Z_BUF_ERROR) return GzipEnd::truncated;
    if (code == Z_MEM_ERROR) throw std::bad_alloc{};
    const std::string_view message = stream_.msg == nullptr ? "" : stream_.msg;
    const bool trailer = message == "incorrect data check" || message == "incorrect length check";
    return trailer ? GzipEnd::bad_checksum : GzipEnd::corrupt;
}

std::vector<std::byte> without_gzip(std::span<const std::byte> bytes) {
    if (!is_gzip(bytes)) return {bytes.begin(), bytes.end()};
    GzipStream gzip(bytes);
    std::vector<std::byte> inside;
    for (auto piece = gzip.next(); !piece.empty(); piece = gzip.next())
        inside.insert(inside.end(), piece.begin(), piece.end());
    return inside;
}

}  // namespace stormcellar::level2

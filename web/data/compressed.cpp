#include "web/data/compressed.h"

#include <limits>

#include <zlib.h>
#include <zstd.h>

namespace stormcellar::web {

std::string_view coding_name(Coding coding) {
    switch (coding) {
        case Coding::gzip:
            return "gzip";
        case Coding::zstd:
            return "zstd";
        case Coding::identity:
            break;
    }
    return "";
}

Coding coding_for(const Request& request) {
    if (request.accepts("zstd")) return Coding::zstd;
    return request.accepts("gzip") ? Coding::gzip : Coding::identity;
}

Result<std::string> compressed(std::string_view bytes, Coding coding) {
    switch (coding) {
        case Coding::gzip:
            return gzipped(bytes, gzip_level);
        case Coding::zstd:
            return zstd_packed(bytes, zstd_level);
        case Coding::identity:
            break;
    }
    return std::string(bytes);
}

Result<std::string> gzipped(std::string_view bytes, int level) {
    if (bytes.size() > std::numeric_limits<uInt>::max()) {
        return fail(ErrorCode::bad_argument, "{} bytes are too many to compress", bytes.size());
    }
    constexpr int window_with_gzip_header = 15 + 16;
    constexpr int most_memory = 9;
    z_stream stream{};
    if (::deflateInit2(&stream, level, Z_DEFLATED, window_with_gzip_header, most_memory,
                       Z_DEFAULT_STRATEGY) != Z_OK) {
        return fail(ErrorCode::exhausted, "there is no memory to compress an answer");
    }
    std::string out(::deflateBound(&stream, bytes.size()), '\0');
    // zlib does not change its input, but an old header says that it may.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int done = ::deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    ::deflateEnd(&stream);
    if (done != Z_STREAM_END) return fail(ErrorCode::internal, "zlib did not end its stream");
    out.shrink_to_fit();
    return out;
}

Result<std::string> zstd_packed(std::string_view bytes, int level) {
    std::string out(::ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t size =
        ::ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
    if (::ZSTD_isError(size) != 0) {
        return fail(ErrorCode::exhausted, "zstd: {}", ::ZSTD_getErrorName(size));
    }
    out.resize(size);
    out.shrink_to_fit();
    return out;
}

}  // namespace stormcellar::web

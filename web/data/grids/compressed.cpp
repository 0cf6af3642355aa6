#include "web/data/grids/compressed.h"

#include <zstd.h>

#include "export/gzip_bytes.h"

namespace stormcellar::web {

std::string_view coding_name(Coding coding) {
    if (coding == Coding::identity) return "";
    return coding == Coding::gzip ? "gzip" : "zstd";
}

Coding coding_for(const Request& request) {
    if (request.accepts("zstd")) return Coding::zstd;
    return request.accepts("gzip") ? Coding::gzip : Coding::identity;
}

namespace {

Result<std::string> compressed_by(std::string_view bytes, Coding coding, int of_gzip, int of_zstd) {
    if (coding == Coding::identity) return std::string(bytes);
    return coding == Coding::gzip ? gzipped(bytes, of_gzip) : zstd_packed(bytes, of_zstd);
}

}  // namespace

Result<std::string> compressed(std::string_view bytes, Coding coding) {
    return compressed_by(bytes, coding, gzip_level, zstd_level);
}

Result<std::string> compressed_once(std::string_view bytes, Coding coding) {
    return compressed_by(bytes, coding, gzip_once_level, zstd_once_level);
}

Result<std::string> gzipped(std::string_view bytes, int level) {
    return gzip_bytes(bytes, level);
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

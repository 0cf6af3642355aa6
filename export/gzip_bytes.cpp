#include "export/gzip_bytes.h"

#include <memory>

#include <libdeflate.h>

namespace stormcellar {

Result<std::string> gzip_bytes(std::string_view bytes, int level) {
    struct Free {
        void operator()(libdeflate_compressor* compressor) const {
            ::libdeflate_free_compressor(compressor);
        }
    };
    const std::unique_ptr<libdeflate_compressor, Free> compressor(
        ::libdeflate_alloc_compressor(level));
    if (!compressor) return fail(ErrorCode::exhausted, "there is no memory to compress bytes");
    std::string out(::libdeflate_gzip_compress_bound(compressor.get(), bytes.size()), '\0');
    const std::size_t size = ::libdeflate_gzip_compress(compressor.get(), bytes.data(),
                                                        bytes.size(), out.data(), out.size());
    if (size == 0) return fail(ErrorCode::internal, "libdeflate did not end its stream");
    out.resize(size);
    out.shrink_to_fit();
    return out;
}

}  // namespace stormcellar

// render/image/webp_bytes.h -- code for both stills and loops in WebP: owns libwebp's memory, and
// makes the bytes of a file with its metadata. Stills and loops are separate libraries, so all
// functions are inline.
//
// Threads   Pure functions.
// Errors    internal if libwebp refuses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <webp/mux.h>

#include "render/image/xmp.h"
#include "stormcellar/base/result.h"

namespace stormcellar::render {

// Memory of libwebp. It is freed at the end of a scope.
struct WebpBytes {
    WebPData data{};
    WebpBytes() { WebPDataInit(&data); }
    WebpBytes(const WebpBytes&) = delete;
    WebpBytes& operator=(const WebpBytes&) = delete;
    ~WebpBytes() { WebPDataClear(&data); }
};

struct WebpMuxDeleter {
    void operator()(WebPMux* mux) const { WebPMuxDelete(mux); }
};

[[nodiscard]] inline tl::unexpected<Error> webp_version_mismatch() {
    return fail(ErrorCode::internal, "WebP: the library's version is not the header's");
}

// Returns a copy of an encoded file. If there are texts, adds them as XMP.
[[nodiscard]] inline Result<std::vector<std::byte>> webp_file(const WebPData& encoded,
                                                              const PictureTexts& texts) {
    const auto copy_of = [](const WebPData& data) {
        const auto bytes = std::as_bytes(std::span(data.bytes, data.size));
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    };
    if (texts.empty()) return copy_of(encoded);
    const std::unique_ptr<WebPMux, WebpMuxDeleter> mux(WebPMuxCreate(&encoded, 0));
    const std::string packet = xmp_packet(texts);
    const WebPData xmp{reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()};
    WebpBytes whole;
    if (!mux || WebPMuxSetChunk(mux.get(), "XMP ", &xmp, 0) != WEBP_MUX_OK ||
        WebPMuxAssemble(mux.get(), &whole.data) != WEBP_MUX_OK) {
        return fail(ErrorCode::internal, "WebP: the metadata cannot be added");
    }
    return copy_of(whole.data);
}

}  // namespace stormcellar::render

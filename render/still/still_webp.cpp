// WebP through libwebp, lossless as in loops (render/animation/animation_webp.cpp).
#include <memory>
#include <span>
#include <string>

#include <webp/encode.h>
#include <webp/mux.h>

#include "render/image/xmp.h"
#include "render/still/still_format.h"

namespace stormcellar::render {
namespace {

constexpr int still_method = 3;  // a still has more time than the frames of a loop
constexpr float still_effort = 60;

struct StillMuxDeleter {
    void operator()(WebPMux* mux) const { WebPMuxDelete(mux); }
};

// Memory of libwebp, freed at the end of a scope.
struct StillData {
    WebPData data{};
    StillData() { WebPDataInit(&data); }
    StillData(const StillData&) = delete;
    StillData& operator=(const StillData&) = delete;
    ~StillData() { WebPDataClear(&data); }
};
struct StillWriter {
    WebPPicture picture{};
    WebPMemoryWriter writer{};
    StillWriter() { WebPMemoryWriterInit(&writer); }
    StillWriter(const StillWriter&) = delete;
    StillWriter& operator=(const StillWriter&) = delete;
    ~StillWriter() {
        WebPPictureFree(&picture);
        WebPMemoryWriterClear(&writer);
    }
};

std::vector<std::byte> copy_of(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    return {bytes.begin(), bytes.end()};
}

}  // namespace

Result<std::vector<std::byte>> encode_webp(const Image& picture, const StillOptions& options) {
    if (auto fits = check_picture(picture, WEBP_MAX_DIMENSION); !fits) return pass_on(fits);
    StillWriter out;
    WebPConfig config;
    if (WebPPictureInit(&out.picture) == 0 || WebPConfigInit(&config) == 0) {
        return fail(ErrorCode::internal, "WebP: the library's version is not the header's");
    }
    config.lossless = 1;
    config.exact = 1;
    config.method = still_method;
    config.quality = still_effort;
    config.thread_level = options.threads > 1 ? 1 : 0;
    out.picture.use_argb = 1;
    out.picture.width = picture.width;
    out.picture.height = picture.height;
    out.picture.writer = WebPMemoryWrite;
    out.picture.custom_ptr = &out.writer;
    if (WebPPictureImportRGBA(&out.picture, picture.rgba.data(), picture.width * 4) == 0) {
        return fail(ErrorCode::internal, "WebP: no memory for a picture");
    }
    if (WebPEncode(&config, &out.picture) == 0) {
        return fail(ErrorCode::internal, "WebP: error {} of the encoder",
                    static_cast<int>(out.picture.error_code));
    }
    if (options.metadata.empty()) return copy_of(out.writer.mem, out.writer.size);
    const WebPData plain{out.writer.mem, out.writer.size};
    const std::unique_ptr<WebPMux, StillMuxDeleter> mux(WebPMuxCreate(&plain, 0));
    const std::string packet = xmp_packet(options.metadata);
    const WebPData xmp{reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()};
    StillData whole;
    if (!mux || WebPMuxSetChunk(mux.get(), "XMP ", &xmp, 0) != WEBP_MUX_OK ||
        WebPMuxAssemble(mux.get(), &whole.data) != WEBP_MUX_OK) {
        return fail(ErrorCode::internal, "WebP: the metadata cannot be added");
    }
    return copy_of(whole.data.bytes, whole.data.size);
}

}  // namespace stormcellar::render

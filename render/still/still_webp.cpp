// Writes WebP with libwebp, lossless as in loops (render/animation/animation_webp.cpp).
#include <webp/encode.h>

#include "render/image/check_size.h"
#include "render/image/webp_bytes.h"
#include "render/still/still_format.h"

namespace stormcellar::render {
namespace {

constexpr int still_method = 3;  // a still has more time than the frames of a loop
constexpr float still_effort = 60;

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

}  // namespace

Result<std::vector<std::byte>> encode_webp(const Image& picture, const StillOptions& options) {
    if (auto fits = check_size(picture, WEBP_MAX_DIMENSION, "picture"); !fits) return pass_on(fits);
    StillWriter out;
    WebPConfig config;
    if (WebPPictureInit(&out.picture) == 0 || WebPConfigInit(&config) == 0) {
        return webp_version_mismatch();
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
    return webp_file({out.writer.mem, out.writer.size}, options.metadata);
}

}  // namespace stormcellar::render

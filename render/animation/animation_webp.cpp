// Writes WebP loops with libwebp's animation encoder. They are lossless, because colors are data,
// and lossy WebP would halve the resolution of colors. Method 1 and effort 50 give most of the
// possible compression in little time.
#include <climits>
#include <cmath>

#include <webp/encode.h>
#include <webp/mux.h>

#include "render/animation/animation_format.h"
#include "render/image/webp_bytes.h"

namespace stormcellar::render {
namespace {

constexpr int method = 1;
constexpr float effort = 50;

struct EncoderDeleter {
    void operator()(WebPAnimEncoder* encoder) const { WebPAnimEncoderDelete(encoder); }
};
struct Picture {
    WebPPicture picture{};
    Picture() = default;
    Picture(const Picture&) = delete;
    Picture& operator=(const Picture&) = delete;
    ~Picture() { WebPPictureFree(&picture); }
};

class WebpEncoder final : public FrameEncoder {
  public:
    explicit WebpEncoder(const AnimationOptions& options) : options_(options) {}

    [[nodiscard]] int largest_side() const override { return WEBP_MAX_DIMENSION; }

    Status add(const Image& frame) override {
        if (!encoder_) {
            if (auto started = start(frame.width, frame.height); !started) return started;
        }
        Picture holder;
        WebPPicture& picture = holder.picture;
        if (WebPPictureInit(&picture) == 0) return webp_version_mismatch();
        picture.use_argb = 1;
        picture.width = frame.width;
        picture.height = frame.height;
        if (WebPPictureImportRGBA(&picture, frame.rgba.data(), frame.width * 4) == 0) {
            return fail(ErrorCode::internal, "WebP: no memory for a frame");
        }
        return add_to_encoder(&picture, milliseconds(count_++));
    }

    Result<std::vector<std::byte>> finish() override {
        const auto end = milliseconds(count_) +
                         static_cast<int>(std::llround(options_.last_frame_dwell_s * 1e3));
        if (auto ended = add_to_encoder(nullptr, end); !ended) return pass_on(ended);
        WebpBytes assembled;
        if (WebPAnimEncoderAssemble(encoder_.get(), &assembled.data) == 0) {
            return fail(ErrorCode::internal, "WebP: {}", WebPAnimEncoderGetError(encoder_.get()));
        }
        return webp_file(assembled.data, options_.metadata);
    }

  private:
    [[nodiscard]] int milliseconds(std::size_t index) const {
        return static_cast<int>(frame_start(options_, index, 1000));
    }

    Status start(int width, int height) {
        WebPAnimEncoderOptions options;
        if (WebPAnimEncoderOptionsInit(&options) == 0 || WebPConfigInit(&config_) == 0) {
            return webp_version_mismatch();
        }
        options.anim_params.loop_count = 0;  // without end
        // Key frames are needed only for seeking. Without them, a frame stores only the part that
        // changed.
        options.kmax = INT_MAX;
        options.kmin = INT_MAX - 1;
        config_.lossless = 1;
        config_.exact = 1;
        config_.method = method;
        config_.quality = effort;
        encoder_.reset(WebPAnimEncoderNew(width, height, &options));
        if (!encoder_) return fail(ErrorCode::internal, "WebP: the encoder does not start");
        return {};
    }

    Status add_to_encoder(WebPPicture* picture, int start_ms) {
        if (WebPAnimEncoderAdd(encoder_.get(), picture, start_ms, &config_) == 0) {
            return fail(ErrorCode::internal, "WebP: {}", WebPAnimEncoderGetError(encoder_.get()));
        }
        return {};
    }

    AnimationOptions options_;
    WebPConfig config_{};
    std::unique_ptr<WebPAnimEncoder, EncoderDeleter> encoder_;
    std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<FrameEncoder> make_webp_encoder(const AnimationOptions& options) {
    return std::make_unique<WebpEncoder>(options);
}

}  // namespace stormcellar::render

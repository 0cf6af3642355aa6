// The module for videos, which writes MP4 and WebM with FFmpeg's libavcodec and libavformat.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "render/animation/ffmpeg_handles.h"
#include "render/animation/video_muxer.h"

namespace stormcellar::render {
namespace {

using ffmpeg::failure;
using ffmpeg::Handle;

// The number of threads is fixed, because encoders divide their work among threads, and another
// number of threads would change the result.
constexpr int encoder_threads = 2;

struct Codec {
    VideoContainer container;
    const char* name;
    std::array<std::pair<const char*, const char*>, 6> settings;  // unused entries are null
};

// The codecs, in order of preference. Their bit rates are high, because lossy video halves the
// resolution of colors.
constexpr std::array codecs{
    Codec{VideoContainer::mp4,
          "libx264",
          {{{"preset", "medium"}, {"crf", "16"}, {"x264-params", "cpu-independent=1"}}}},
    Codec{VideoContainer::mp4, "libopenh264", {{{"b", "4M"}}}},
    Codec{VideoContainer::mp4, "mpeg4", {{{"flags", "+qscale"}, {"global_quality", "236"}}}},
    Codec{VideoContainer::webm,
          "libvpx-vp9",
          {{{"b", "0"},
            {"crf", "18"},
            {"deadline", "good"},
            {"cpu-used", "4"},
            {"row-mt", "1"},
            {"lag-in-frames", "16"}}}},
    Codec{VideoContainer::webm,
          "libvpx",
          {{{"b", "4M"}, {"crf", "8"}, {"deadline", "good"}, {"cpu-used", "2"}}}},
};

// Returns the first codec for this container that this FFmpeg has, or null if it has none.
const Codec* choose_codec(VideoContainer container) {
    const auto chosen = std::ranges::find_if(codecs, [container](const Codec& codec) {
        return codec.container == container && avcodec_find_encoder_by_name(codec.name) != nullptr;
    });
    return chosen == codecs.end() ? nullptr : chosen;
}

class VideoEncoder final : public FrameEncoder {
  public:
    VideoEncoder(VideoContainer container, const AnimationOptions& options)
        : container_(container), options_(options) {
        av_log_set_level(AV_LOG_QUIET);
    }

    [[nodiscard]] int largest_side() const override { return 8192; }

    Status add(const Image& image) override {
        if (!encoder_) {
            if (auto started = start(image.width, image.height); !started) return started;
        }
        if (auto converted = convert(image); !converted) return converted;
        return encode_last();
    }

    // Video cannot show the last picture longer (dwell), so repeat that picture instead.
    Result<std::vector<std::byte>> finish() override {
        const auto repeats =
            static_cast<int>(std::lround(options_.last_frame_dwell_s * options_.frames_per_second));
        for (int i = 0; i < repeats; ++i) {
            if (auto encoded = encode_last(); !encoded) return pass_on(encoded);
        }
        if (auto flushed = send(nullptr); !flushed) return pass_on(flushed);
        return mux_video(container_, *encoder_, packets_, options_);
    }

  private:
    Status start(int width, int height) {
        const Codec* codec = choose_codec(container_);
        if (codec == nullptr) {
            return fail(ErrorCode::unsupported, "this FFmpeg has no encoder for {}",
                        container_ == VideoContainer::mp4 ? "H.264 or MPEG-4" : "VP9 or VP8");
        }
        const AVCodec* found = avcodec_find_encoder_by_name(codec->name);
        encoder_.reset(avcodec_alloc_context3(found));
        if (!encoder_) return fail(ErrorCode::internal, "video: no memory for the encoder");
        describe(width, height);
        ffmpeg::Options settings;
        for (const auto& [name, value] : codec->settings) {
            if (name != nullptr) settings.set(name, value);
        }
        const int opened = avcodec_open2(encoder_.get(), found, settings.get());
        if (opened < 0) return failure(codec->name, opened);
        return start_conversion();
    }

    void describe(int width, int height) {
        AVCodecContext& encoder = *encoder_;
        encoder.width = width + width % 2;
        encoder.height = height + height % 2;
        encoder.pix_fmt = AV_PIX_FMT_YUV420P;
        encoder.color_range = AVCOL_RANGE_MPEG;
        encoder.colorspace = AVCOL_SPC_BT709;
        encoder.color_primaries = AVCOL_PRI_BT709;
        encoder.color_trc = AVCOL_TRC_BT709;
        encoder.chroma_sample_location = AVCHROMA_LOC_LEFT;
        encoder.sample_aspect_ratio = {1, 1};
        encoder.framerate = av_d2q(options_.frames_per_second, 60000);
        encoder.time_base = av_inv_q(encoder.framerate);
        encoder.thread_count = encoder_threads;
        encoder.flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
        // A loop is short. For seeking, one key picture in ten seconds is enough, or one in twelve
        // pictures if these last longer.
        encoder.gop_size = std::max(12, static_cast<int>(10 * options_.frames_per_second));
    }

    // Starts the conversion of RGB with the full range to BT.709 with the limited range. The result
    // has the same bits on every machine.
    Status start_conversion() {
        const int even_width = encoder_->width, even_height = encoder_->height;
        even_ = Image(even_width, even_height, {});
        conversion_.reset(sws_getContext(
            even_width, even_height, AV_PIX_FMT_RGBA, even_width, even_height, AV_PIX_FMT_YUV420P,
            SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INP, nullptr, nullptr,
            nullptr));
        if (!conversion_) return fail(ErrorCode::internal, "video: no memory for the conversion");
        const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
        constexpr int full = 1, limited = 0, none = 0, one = 1 << 16;
        if (sws_setColorspaceDetails(conversion_.get(), bt709, full, bt709, limited, none, one,
                                     one) < 0) {
            return fail(ErrorCode::unsupported, "video: this FFmpeg does not convert to BT.709");
        }
        return {};
    }

    // Converts into a new frame each time, because the encoder may still be reading the last frame.
    Status convert(const Image& image) {
        fill_even(image);
        Handle<AVFrame> frame(av_frame_alloc());
        if (!frame) return fail(ErrorCode::internal, "video: no memory for a frame");
        frame->format = encoder_->pix_fmt;
        frame->width = encoder_->width;
        frame->height = encoder_->height;
        frame->colorspace = encoder_->colorspace;
        frame->color_range = encoder_->color_range;
        frame->color_primaries = encoder_->color_primaries;
        frame->color_trc = encoder_->color_trc;
        frame->chroma_location = encoder_->chroma_sample_location;
        if (const int got = av_frame_get_buffer(frame.get(), 0); got < 0) {
            return failure("video frame", got);
        }
        const std::array<const std::uint8_t*, 4> from{even_.rgba.data()};
        const std::array<int, 4> stride{even_.width * 4};
        const int rows = sws_scale(conversion_.get(), from.data(), stride.data(), 0, even_.height,
                                   frame->data, frame->linesize);
        if (rows != even_.height) return failure("video frame", rows < 0 ? rows : AVERROR_UNKNOWN);
        last_ = std::move(frame);
        return {};
    }

    // If a side of the picture is odd, makes it even by repeating the last column or row.
    void fill_even(const Image& image) {
        const auto pixel_bytes = [](int count) { return static_cast<std::size_t>(count) * 4; };
        for (int y = 0; y < even_.height; ++y) {
            const auto* row = image.rgba.data() + pixel_bytes(std::min(y, image.height - 1)) *
                                                      static_cast<std::size_t>(image.width);
            auto* out = even_.rgba.data() + pixel_bytes(y) * static_cast<std::size_t>(even_.width);
            std::copy_n(row, pixel_bytes(image.width), out);
            if (even_.width > image.width) {
                std::copy_n(row + pixel_bytes(image.width - 1), 4, out + pixel_bytes(image.width));
            }
        }
    }

    Status encode_last() {
        last_->pts = next_pts_++;
        return send(last_.get());
    }

    // Gives the encoder a frame, or null at the end. Takes the packets that the encoder has ready.
    Status send(const AVFrame* frame) {
        if (const int sent = avcodec_send_frame(encoder_.get(), frame); sent < 0) {
            return failure("video encoder", sent);
        }
        for (;;) {
            Handle<AVPacket> packet(av_packet_alloc());
            if (!packet) return fail(ErrorCode::internal, "video: no memory for a picture");
            const int received = avcodec_receive_packet(encoder_.get(), packet.get());
            if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return {};
            if (received < 0) return failure("video encoder", received);
            if (packet->duration == 0) packet->duration = 1;
            packets_.push_back(std::move(packet));
        }
    }

    VideoContainer container_;
    AnimationOptions options_;
    Handle<AVCodecContext> encoder_;
    std::vector<Handle<AVPacket>> packets_;
    Handle<SwsContext> conversion_;
    Image even_;
    Handle<AVFrame> last_;
    std::int64_t next_pts_ = 0;
};

}  // namespace
}  // namespace stormcellar::render

extern "C" __attribute__((visibility("default"))) stormcellar::render::FrameEncoder*
stormcellar_make_video_encoder(stormcellar::render::VideoContainer container,
                               const stormcellar::render::AnimationOptions& options) {
    return std::make_unique<stormcellar::render::VideoEncoder>(container, options).release();
}

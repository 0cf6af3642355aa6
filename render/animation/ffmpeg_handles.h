// render/animation/ffmpeg_handles.h -- owns FFmpeg's objects, and converts FFmpeg's errors to ours;
// internal.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "stormcellar/base/result.h"

namespace stormcellar::render::ffmpeg {

struct Deleter {
    void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
    void operator()(AVFormatContext* context) const { avformat_free_context(context); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
    void operator()(SwsContext* context) const { sws_freeContext(context); }
};
template <class T>
using Handle = std::unique_ptr<T, Deleter>;

// Options of a codec or a container, by name and value. FFmpeg removes each option that it knows,
// so unknown options remain.
class Options {
  public:
    Options() = default;
    Options(const Options&) = delete;
    Options& operator=(const Options&) = delete;
    ~Options() { av_dict_free(&dictionary_); }
    void set(const std::string& name, const std::string& value) {
        av_dict_set(&dictionary_, name.c_str(), value.c_str(), 0);
    }
    [[nodiscard]] AVDictionary** get() { return &dictionary_; }

  private:
    AVDictionary* dictionary_ = nullptr;
};

// Returns an error with the text "what: reason". The reason is FFmpeg's own text for its error
// number.
[[nodiscard]] inline tl::unexpected<Error> failure(const char* what, int number) {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
    av_strerror(number, reason.data(), reason.size());
    return fail(ErrorCode::internal, "{}: {}", what, reason.data());
}

}  // namespace stormcellar::render::ffmpeg

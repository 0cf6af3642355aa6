// Reads animations with FFmpeg's demuxers and decoders, so that foreign code checks our files.
#include "render/animation/ffmpeg_handles.h"
#include "tests/render/decoded_animation.h"

namespace stormcellar::render {
namespace {

using ffmpeg::Handle;

void read_metadata(const AVDictionary* dictionary, DecodedAnimation& result) {
    const AVDictionaryEntry* entry = nullptr;
    while ((entry = av_dict_get(dictionary, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr) {
        result.metadata[entry->key] = entry->value;
    }
}

Image to_rgba(const AVFrame& frame) {
    const Handle<SwsContext> conversion(sws_getContext(
        frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
        frame.height, AV_PIX_FMT_RGBA, SWS_POINT | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr,
        nullptr, nullptr));
    const int* coefficients = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(conversion.get(), coefficients, frame.color_range == AVCOL_RANGE_JPEG,
                             coefficients, 1, 0, 1 << 16, 1 << 16);
    Image image(frame.width, frame.height, {});
    std::uint8_t* const out = image.rgba.data();
    const int stride = frame.width * 4;
    sws_scale(conversion.get(), frame.data, frame.linesize, 0, frame.height, &out, &stride);
    return image;
}

// Returns the duration in ticks. The field has another name since FFmpeg 6.
std::int64_t duration(const AVFrame& frame) {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(57, 30, 0)
    return frame.duration;
#else
    return frame.pkt_duration;
#endif
}

// Takes all pictures that the decoder has ready.
void receive(AVCodecContext& decoder, AVRational time_base, DecodedAnimation& result) {
    const Handle<AVFrame> frame(av_frame_alloc());
    while (avcodec_receive_frame(&decoder, frame.get()) == 0) {
        read_metadata(frame->metadata, result);
        const double tick = av_q2d(time_base);
        result.frames.push_back({to_rgba(*frame), static_cast<double>(frame->pts) * tick,
                                 static_cast<double>(duration(*frame)) * tick});
    }
}

struct CloseInput {
    void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};

}  // namespace

DecodedAnimation decode_with_ffmpeg(const std::filesystem::path& path) {
    AVFormatContext* opened = nullptr;
    if (avformat_open_input(&opened, path.c_str(), nullptr, nullptr) < 0) {
        return {.error = "FFmpeg does not open it"};
    }
    const std::unique_ptr<AVFormatContext, CloseInput> input(opened);
    if (avformat_find_stream_info(input.get(), nullptr) < 0 || input->nb_streams != 1) {
        return {.error = "FFmpeg finds no stream, or several"};
    }
    const AVStream& stream = *input->streams[0];
    const AVCodec* codec = avcodec_find_decoder(stream.codecpar->codec_id);
    const Handle<AVCodecContext> decoder(avcodec_alloc_context3(codec));
    avcodec_parameters_to_context(decoder.get(), stream.codecpar);
    decoder->pkt_timebase = stream.time_base;
    if (avcodec_open2(decoder.get(), codec, nullptr) < 0) return {.error = "no decoder"};

    DecodedAnimation result;
    result.codec = codec->name;
    read_metadata(input->metadata, result);
    const Handle<AVPacket> packet(av_packet_alloc());
    while (av_read_frame(input.get(), packet.get()) == 0) {
        if (avcodec_send_packet(decoder.get(), packet.get()) < 0) {
            result.error = "FFmpeg cannot decode a picture";
        }
        av_packet_unref(packet.get());
        receive(*decoder, stream.time_base, result);
    }
    avcodec_send_packet(decoder.get(), nullptr);
    receive(*decoder, stream.time_base, result);
    return result;
}

}  // namespace stormcellar::render

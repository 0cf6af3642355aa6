#include "render/animation/video_muxer.h"

#include <algorithm>
#include <cstdio>
#include <span>

#include "render/image/xmp.h"

namespace stormcellar::render {
namespace {

using ffmpeg::failure;
using ffmpeg::Handle;

// A file in memory, for a library that must seek while it writes.
class MemoryFile {
  public:
    static constexpr std::size_t limit = std::size_t{1} << 31;

    MemoryFile() {
        constexpr int buffer_size = 1 << 16;
        auto* buffer = static_cast<unsigned char*>(av_malloc(buffer_size));
        if (buffer != nullptr) {
            io_ = avio_alloc_context(buffer, buffer_size, 1, this, nullptr, write, seek);
        }
        if (io_ == nullptr) av_free(buffer);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() {
        if (io_ == nullptr) return;
        av_freep(&io_->buffer);
        avio_context_free(&io_);
    }
    [[nodiscard]] AVIOContext* io() const { return io_; }
    std::vector<std::byte> take() {
        avio_flush(io_);
        return std::move(bytes_);
    }

  private:
    // `Byte` is FFmpeg's type: std::uint8_t up to version 6, const std::uint8_t since version 7.
    template <class Byte>
    static int write(void* self, Byte* data, int size) {
        auto& file = *static_cast<MemoryFile*>(self);
        const auto part = std::as_bytes(std::span(data, static_cast<std::size_t>(size)));
        const std::size_t end = file.position_ + part.size();
        if (end > limit) return AVERROR(EFBIG);
        if (end > file.bytes_.size()) file.bytes_.resize(end);
        std::ranges::copy(part, file.bytes_.begin() + static_cast<std::ptrdiff_t>(file.position_));
        file.position_ = end;
        return size;
    }
    static std::int64_t seek(void* self, std::int64_t offset, int whence) {
        auto& file = *static_cast<MemoryFile*>(self);
        const auto size = static_cast<std::int64_t>(file.bytes_.size());
        if (whence == AVSEEK_SIZE) return size;
        if (whence == SEEK_CUR) offset += static_cast<std::int64_t>(file.position_);
        if (whence == SEEK_END) offset += size;
        if (offset < 0 || offset > static_cast<std::int64_t>(limit)) return AVERROR(EINVAL);
        file.position_ = static_cast<std::size_t>(offset);
        return offset;
    }

    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
    AVIOContext* io_ = nullptr;
};

void set_metadata(AVFormatContext& format, const AnimationOptions& options) {
    if (const std::string title = title_of(options.metadata); !title.empty()) {
        av_dict_set(&format.metadata, "title", title.c_str(), 0);
    }
    if (const std::string text = text_of(options.metadata); !text.empty()) {
        av_dict_set(&format.metadata, "comment", text.c_str(), 0);
    }
}

Status add_stream(AVFormatContext& format, const AVCodecContext& encoder) {
    AVStream* stream = avformat_new_stream(&format, nullptr);
    if (stream == nullptr) return fail(ErrorCode::internal, "video: no memory for the container");
    stream->time_base = encoder.time_base;
    stream->avg_frame_rate = encoder.framerate;
    const int copied = avcodec_parameters_from_context(stream->codecpar, &encoder);
    if (copied < 0) return failure("video container", copied);
    return {};
}

Status write_packets(AVFormatContext& format, const AVCodecContext& encoder,
                     const std::vector<Handle<AVPacket>>& packets) {
    for (const auto& packet : packets) {
        const Handle<AVPacket> copy(av_packet_clone(packet.get()));
        if (!copy) return fail(ErrorCode::internal, "video: no memory for a picture");
        copy->stream_index = 0;
        av_packet_rescale_ts(copy.get(), encoder.time_base, format.streams[0]->time_base);
        const int written = av_write_frame(&format, copy.get());
        if (written < 0) return failure("video container", written);
    }
    return {};
}

// Returns an upper bound for the size of the index of an MP4 file. Its tables take at most 40 bytes
// for each picture (ISO 14496-12, 8.6 and 8.7). In addition, there is room for metadata and for the
// configuration of the decoder.
std::size_t index_size(const AVCodecContext& encoder, std::size_t packets,
                       const AnimationOptions& options) {
    return 8192 + 64 * packets + 4 * text_of(options.metadata).size() +
           static_cast<std::size_t>(encoder.extradata_size);
}

}  // namespace

Result<std::vector<std::byte>> mux_video(VideoContainer container, const AVCodecContext& encoder,
                                         const std::vector<Handle<AVPacket>>& packets,
                                         const AnimationOptions& options) {
    const bool mp4 = container == VideoContainer::mp4;
    AVFormatContext* made = nullptr;
    const int created =
        avformat_alloc_output_context2(&made, nullptr, mp4 ? "mp4" : "webm", nullptr);
    if (created < 0) return failure("video container", created);
    MemoryFile file;
    const Handle<AVFormatContext> format(made);
    if (file.io() == nullptr) return fail(ErrorCode::internal, "video: no memory for the file");
    format->pb = file.io();
    format->flags |= AVFMT_FLAG_BITEXACT | AVFMT_FLAG_CUSTOM_IO;
    set_metadata(*format, options);
    if (auto added = add_stream(*format, encoder); !added) return pass_on(added);

    ffmpeg::Options settings;
    if (mp4)
        settings.set("moov_size", std::to_string(index_size(encoder, packets.size(), options)));
    const int began = avformat_write_header(format.get(), settings.get());
    if (began < 0) return failure("video container", began);
    if (auto written = write_packets(*format, encoder, packets); !written) return pass_on(written);
    const int ended = av_write_trailer(format.get());
    if (ended < 0) return failure("video container", ended);
    return file.take();
}

}  // namespace stormcellar::render

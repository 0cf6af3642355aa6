// render/animation/video_muxer.h -- encoded pictures -> the bytes of an MP4 or WebM file; internal.
#pragma once

#include <cstddef>
#include <vector>

#include "render/animation/animation_format.h"
#include "render/animation/ffmpeg_handles.h"

namespace stormcellar::render {

// Puts packets, whose times are in the encoder's time base, into a container in memory. MP4 has
// its index in front, so that a browser can begin before it has the whole. No date, no name of the
// library: the same packets give the same bytes.
[[nodiscard]] Result<std::vector<std::byte>> mux_video(
    VideoContainer container, const AVCodecContext& encoder,
    const std::vector<ffmpeg::Handle<AVPacket>>& packets, const AnimationOptions& options);

}  // namespace stormcellar::render

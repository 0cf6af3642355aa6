// render/animation/video_muxer.h -- makes the bytes of an MP4 or WebM file from encoded pictures;
// internal.
#pragma once

#include <cstddef>
#include <vector>

#include "render/animation/animation_format.h"
#include "render/animation/ffmpeg_handles.h"

namespace stormcellar::render {

// Puts packets into a container in memory. Their times are in the time base of the encoder. An MP4
// file has its index at the front, so that a browser can begin before it has the whole file. The
// file holds no date and no library name, so the same packets give the same bytes.
[[nodiscard]] Result<std::vector<std::byte>> mux_video(
    VideoContainer container, const AVCodecContext& encoder,
    const std::vector<ffmpeg::Handle<AVPacket>>& packets, const AnimationOptions& options);

}  // namespace stormcellar::render

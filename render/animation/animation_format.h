// render/animation/animation_format.h -- what the formats of stormcellar/render/animation.h share;
// internal.
//
// A FrameEncoder turns frames into the bytes of one file, in memory. The checks, the errors' file
// name and the writing are the same for all and stand in animation.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::render {

class FrameEncoder {
  public:
    FrameEncoder() = default;
    FrameEncoder(const FrameEncoder&) = delete;
    FrameEncoder& operator=(const FrameEncoder&) = delete;
    virtual ~FrameEncoder() = default;

    // Called with frames of one size only; errors carry a reason and no file name.
    virtual Status add(const Image& frame) = 0;
    // Called once, after at least one frame: the whole file.
    virtual Result<std::vector<std::byte>> finish() = 0;
    // How many pixels a side may have.
    [[nodiscard]] virtual int largest_side() const = 0;
};

[[nodiscard]] std::unique_ptr<FrameEncoder> make_webp_encoder(const AnimationOptions& options);
[[nodiscard]] std::unique_ptr<FrameEncoder> make_gif_encoder(const AnimationOptions& options);
[[nodiscard]] std::unique_ptr<FrameEncoder> make_apng_encoder(const AnimationOptions& options);
enum class VideoContainer { mp4, webm };
// From the module of videos (render/animation/video_module.cpp), in a build with STORMCELLAR_VIDEO.
// unsupported: the module or a library that it needs is not there.
[[nodiscard]] Result<std::unique_ptr<FrameEncoder>> make_video_encoder(
    VideoContainer container, const AnimationOptions& options);
// What the module exports, by that name and in C's manner; the caller owns it.
using MakeVideoEncoder = FrameEncoder* (*)(VideoContainer, const AnimationOptions&);
inline constexpr const char* video_module_file = "stormcellar_video.so";
inline constexpr const char* video_module_entry = "stormcellar_make_video_encoder";

// The output is the directory's name, with its '/'.
[[nodiscard]] Result<std::unique_ptr<AnimationWriter>> make_png_directory_writer(
    const std::string& output, const AnimationOptions& options, FileSystem& file_system);

// Bytes that fit the size, at least one pixel, no side above the limit, the size of the first.
[[nodiscard]] Status check_frame(const Image& frame, int first_width, int first_height,
                                 int largest_side);

// When frame `index` begins, in ticks; rounded from the exact time, so that nothing adds up.
[[nodiscard]] std::int64_t frame_start(const AnimationOptions& options, std::size_t index,
                                       double ticks_per_second);
// How long it stays, the dwell of the last one included.
[[nodiscard]] std::int64_t frame_duration(const AnimationOptions& options, std::size_t index,
                                          bool last, double ticks_per_second);

// "Title: KTLX\nSource: ...": all metadata as one text.
[[nodiscard]] std::string metadata_text(const AnimationOptions& options);
[[nodiscard]] std::string metadata_title(const AnimationOptions& options);  // may be empty

}  // namespace stormcellar::render

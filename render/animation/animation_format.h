// render/animation/animation_format.h -- the common parts of the formats of
// stormcellar/render/animation.h; internal.
//
// A FrameEncoder turns frames into the bytes of one file, in memory. animation.cpp does what all
// formats need: it checks frames, writes the file, and names the file in errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/interface.h"
#include "stormcellar/render/animation.h"

namespace stormcellar::render {

class FrameEncoder : public Interface {
  public:
    // Adds a frame. All frames must have the same size. An error gives a reason and no file name.
    virtual Status add(const Image& frame) = 0;
    // Returns the whole file. Called once, after at least one frame.
    virtual Result<std::vector<std::byte>> finish() = 0;
    // Returns the largest number of pixels that the format allows along a side.
    [[nodiscard]] virtual int largest_side() const = 0;
};

[[nodiscard]] std::unique_ptr<FrameEncoder> make_webp_encoder(const AnimationOptions& options);
[[nodiscard]] std::unique_ptr<FrameEncoder> make_gif_encoder(const AnimationOptions& options);
[[nodiscard]] std::unique_ptr<FrameEncoder> make_apng_encoder(const AnimationOptions& options);
enum class VideoContainer { mp4, webm };
// Makes an encoder from the module for videos (render/animation/video_module.cpp). Only a build
// with STORMCELLAR_VIDEO has it. Errors: unsupported if the module or one of its libraries is
// missing.
[[nodiscard]] Result<std::unique_ptr<FrameEncoder>> make_video_encoder(
    VideoContainer container, const AnimationOptions& options);
// The type of the function that the module exports, with C linkage. The caller owns the result.
using MakeVideoEncoder = FrameEncoder* (*)(VideoContainer, const AnimationOptions&);
inline constexpr const char* video_module_file = "stormcellar_video.so";
inline constexpr const char* video_module_entry = "stormcellar_make_video_encoder";

// Makes a writer for a directory of PNG files. `output` is the name of the directory, with its '/'.
[[nodiscard]] Result<std::unique_ptr<AnimationWriter>> make_png_directory_writer(
    const std::string& output, const AnimationOptions& options, FileSystem& file_system);

// Checks the frame (render/image/check_size.h), and that it is as large as the first frame.
[[nodiscard]] Status check_frame(const Image& frame, int first_width, int first_height,
                                 int largest_side);

// Returns the time at which frame `index` begins, in ticks. It is rounded from the exact time, so
// that errors do not add up.
[[nodiscard]] std::int64_t frame_start(const AnimationOptions& options, std::size_t index,
                                       double ticks_per_second);
// Returns how long the frame is shown, in ticks. For the last frame, this includes the dwell.
[[nodiscard]] std::int64_t frame_duration(const AnimationOptions& options, std::size_t index,
                                          bool last, double ticks_per_second);

}  // namespace stormcellar::render

// render/animation.h -- frames -> a looping animation file.
//
// The format follows the name's ending: .webp (libwebp), .gif .mp4 .webm .apng (FFmpeg, when built
// with it), or a name that ends in '/' for a directory of PNG files. Loops run for ever. GIF has
// one palette for the whole loop. The file appears whole, by rename, at finish(); an unfinished
// writer leaves nothing behind. The same frames give the same bytes.
// Thread contract: one writer, one thread.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "render/image.h"

namespace stormcellar::render {

struct AnimationOptions {
    double frames_per_second = 8;   // 0.1 to 60
    double last_frame_dwell_s = 1;  // the last frame stays this much longer
    std::vector<std::pair<std::string, std::string>> metadata;  // written where the format allows
};

class AnimationWriter {
  public:
    // bad_argument names the endings that this build knows.
    static Result<std::unique_ptr<AnimationWriter>> create(const std::string& output,
                                                           const AnimationOptions& options);
    AnimationWriter() = default;
    AnimationWriter(const AnimationWriter&) = delete;
    AnimationWriter& operator=(const AnimationWriter&) = delete;
    virtual ~AnimationWriter() = default;

    // All frames have the size of the first.
    virtual Status add(const Image& frame) = 0;
    virtual Status finish() = 0;  // bad_argument when there was no frame
};

}  // namespace stormcellar::render

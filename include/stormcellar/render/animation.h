// stormcellar/render/animation.h -- frames -> a looping animation file.
//
// The format follows the name's ending:
//   .webp  lossless; alpha kept; metadata as XMP (libwebp)
//   .gif   one palette of at most 255 colours for the whole loop, the same colour always gives the
//          same entry, so nothing flickers; exact when the loop has no more colours than that;
//          times in 1/100 s, at least 2/100; metadata as a comment
//   .apng  lossless; alpha kept; metadata as tEXt chunks
//   .mp4   H.264 (CRF 16, BT.709), or MPEG-4 part 2 where FFmpeg has no H.264 encoder
//   .webm  VP9, or VP8; both only in a build with STORMCELLAR_VIDEO, by a module that is loaded
//   when
//          such a writer is created, from where it is installed with the program
//   NAME/  a directory of frame_0000.png, frame_0001.png, ...; alpha kept
// Loops run for ever where the format has it (MP4, WebM and PNG files do not). Video has even
// sizes: an odd picture gets its last column or row twice. Alpha is dropped where it is not named
// above.
//
// The file appears whole, by rename, at finish(), and an old one is replaced; an unfinished writer
// leaves nothing behind. A directory is replaced when it is empty or holds frames alone; a crash
// between the two renames that this takes can leave the old one under a temporary name.
// The same frames give the same bytes (with the same versions of the libraries).
// Memory: the compressed frames are held until finish(), and one or two as pixels.
// Thread contract: one writer, one thread. Creating a video writer silences FFmpeg's log in the
// whole process; its messages come back in the errors.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/number_range.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

namespace limits {
inline constexpr NumberRange frames_per_second{0.1, 60};
inline constexpr NumberRange last_frame_dwell_s{0, 60};
}  // namespace limits

struct AnimationOptions {
    double frames_per_second = 8;
    double last_frame_dwell_s = 1;  // the last frame stays this much longer
    // Keyword and text. "Title" becomes the title where the format has one, all others its comment.
    std::vector<std::pair<std::string, std::string>> metadata{};
};

// What this build can write, as a user would type it: ".webp, .gif, ..., DIR/".
[[nodiscard]] std::string known_animation_endings();

// bad_argument for a name that no build writes to: an unknown ending (the message names those that
// this build knows), or a directory that is there and named without its "/". Videos pass in every
// build. Nothing is made.
[[nodiscard]] Status check_animation_name(const std::string& output);

class AnimationWriter {
  public:
    // bad_argument: an ending that this build does not know (the message names those it does), or
    // options outside their range. unsupported: the module of videos is not there. The reason of
    // the system when the file could not be written, so that nobody draws frames for nothing.
    // `file_system` must outlive the writer.
    static Result<std::unique_ptr<AnimationWriter>> create(
        const std::string& output, const AnimationOptions& options,
        FileSystem& file_system = real_file_system());
    AnimationWriter() = default;
    AnimationWriter(const AnimationWriter&) = delete;
    AnimationWriter& operator=(const AnimationWriter&) = delete;
    virtual ~AnimationWriter() = default;

    // All frames have the size of the first; bad_argument otherwise. After an error the writer is
    // of no more use: every later call gives the same error.
    virtual Status add(const Image& frame) = 0;
    virtual Status finish() = 0;  // bad_argument when there was no frame, or when called twice
};

}  // namespace stormcellar::render

// stormcellar/render/animation.h -- writes frames to a looping animation file.
//
// The ending of the name selects the format:
//   .webp  lossless; alpha is kept; metadata as XMP (libwebp)
//   .gif   one palette of at most 255 colors for the whole loop. The same color always gets the
//          same entry, so nothing flickers. Colors are exact if the loop has at most 255. Times are
//          in 1/100 s, at least 2/100. Metadata as a comment
//   .apng  lossless; alpha is kept; metadata as tEXt chunks
//   .mp4   H.264 (CRF 16, BT.709), or MPEG-4 part 2 if FFmpeg has no H.264 encoder
//   .webm  VP9, or VP8
//   NAME/  a directory of frame_0000.png, frame_0001.png, ...; alpha is kept; metadata as tEXt
//          chunks
// .mp4 and .webm need a build with STORMCELLAR_VIDEO. A module that is installed with the program
// writes them; it is loaded when a video writer is created.
//
// Loops repeat without end if the format can say so (MP4, WebM and PNG files cannot). Video has
// even sizes, so a picture with an odd size gets its last column or row twice. Formats drop alpha
// unless the list above says that they keep it.
//
// The file appears whole, by rename, at finish(), and replaces an old file. A writer that does not
// finish leaves nothing behind. A directory is replaced if it is empty or holds only frames. This
// takes two renames; a crash between them can leave the old directory under a temporary name. The
// same frames give the same bytes, with the same versions of the libraries.
//
// Memory    The compressed frames of a file are held until finish(); the frames of a directory are
//           written at once. One or two frames are held as pixels.
// Units     Seconds; frames per second.
// Threads   A writer may be used by one thread at a time. Creating a video writer silences FFmpeg's
//           log in the whole process; its messages come back in the errors.
// Errors    See each function.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/interface.h"
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
    // Pairs of keyword and text. A video has the text of "Title" as its title and all texts in its
    // comment.
    std::vector<std::pair<std::string, std::string>> metadata{};
};

// Returns the endings that this build can write, as a user would type them: ".webp, .gif, ...,
// DIR/".
[[nodiscard]] std::string known_animation_endings();

// Checks a name without making anything. Returns bad_argument for a name that no build can write:
// an unknown ending (the message lists the endings that this build knows), or an existing directory
// without its "/". Names of videos pass in every build.
[[nodiscard]] Status check_animation_name(const std::string& output);

class AnimationWriter : public Interface {
  public:
    // Creates a writer. `file_system` must outlive it. Errors: bad_argument for an ending that this
    // build does not know (the message lists the known endings), for options outside their range,
    // and for metadata with a zero byte or with a keyword that is empty or longer than 79
    // characters; unsupported if the module for videos is missing; the system's reason if the file
    // cannot be written. create() notices all these errors before any frame is drawn.
    static Result<std::unique_ptr<AnimationWriter>> create(
        const std::string& output, const AnimationOptions& options,
        FileSystem& file_system = real_file_system());

    // Adds a frame. All frames must have the size of the first, or add() returns bad_argument.
    // After an error the writer is useless: every later call returns the same error.
    virtual Status add(const Image& frame) = 0;
    // Writes the file. Errors: bad_argument if there was no frame or if finish() was called before;
    // the error of an earlier call; those of the encoder and of the file system.
    virtual Status finish() = 0;
};

}  // namespace stormcellar::render

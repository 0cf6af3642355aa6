// cli/loop/loop_encoding.h -- encodes a frame of a loop into all output files while the next frame
// is drawn.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/animation.h"
#include "stormcellar/render/image.h"

namespace stormcellar::cli {

using Writers = std::vector<std::unique_ptr<render::AnimationWriter>>;

// Returns one writer for each output, in the same order.
[[nodiscard]] Result<Writers> make_writers(const std::vector<std::string>& outputs,
                                           const render::AnimationOptions& options);

// Encodes the previous frame while the next one is drawn, with a thread for each writer.
class Encoding {
  public:
    explicit Encoding(Writers writers) : writers_(std::move(writers)) {}

    // Waits until the previous frame is encoded, starts to encode this frame, and returns the first
    // error of the previous frame.
    Status add(render::Image frame);
    // Waits for the last frame and then finishes each file. Does not begin another file once `stop`
    // is set.
    Status finish(const std::atomic<bool>& stop);
    // Returns the seconds of encoding, summed over the writers. Call it after finish().
    [[nodiscard]] double encode_s() const { return encode_s_; }

  private:
    struct Timed {
        Status status;
        double seconds = 0;
    };
    // Waits for all writers and returns the first error.
    Status wait();

    Writers writers_;
    render::Image frame_;
    double encode_s_ = 0;
    // declared last, so that its destructor waits before other members are destroyed
    std::vector<std::future<Timed>> running_;
};

}  // namespace stormcellar::cli

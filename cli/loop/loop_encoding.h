// cli/loop/loop_encoding.h -- the frames of a loop into all its files, beside the drawing of the
// next one.
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

// One writer an output, in this order.
[[nodiscard]] Result<Writers> make_writers(const std::vector<std::string>& outputs,
                                           const render::AnimationOptions& options);

// Encodes one frame behind the one that is being drawn, each writer on a thread of its own.
class Encoding {
  public:
    explicit Encoding(Writers writers) : writers_(std::move(writers)) {}

    // Takes the frame; gives the outcome of the one before.
    Status add(render::Image frame);
    // Stops before the next file when the flag is set.
    Status finish(const std::atomic<bool>& stop);
    // Summed over the writers; after finish().
    [[nodiscard]] double encode_s() const { return encode_s_; }

  private:
    struct Timed {
        Status status;
        double seconds = 0;
    };
    // The first error, when all are done.
    Status wait();

    Writers writers_;
    render::Image frame_;
    double encode_s_ = 0;
    std::vector<std::future<Timed>> running_;  // the last member: waited for before the rest goes
};

}  // namespace stormcellar::cli

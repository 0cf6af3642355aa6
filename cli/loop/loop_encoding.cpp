#include "cli/loop/loop_encoding.h"

#include "base/steady_time.h"
#include "cli/picture/picture.h"

namespace stormcellar::cli {

using Writers = std::vector<std::unique_ptr<render::AnimationWriter>>;

Result<Writers> make_writers(const std::vector<std::string>& outputs,
                             const render::AnimationOptions& options) {
    Writers writers;
    for (const std::string& output : outputs) {
        auto writer = render::AnimationWriter::create(output, options);
        if (!writer) return pass_on(writer);
        writers.push_back(std::move(*writer));
    }
    return writers;
}

Status Encoding::add(render::Image frame) {
    if (auto before = wait(); !before) return before;
    frame_ = std::move(frame);
    for (const auto& writer : writers_) {
        running_.push_back(std::async(std::launch::async, [this, &writer]() -> Timed {
            const auto start = steady_now();
            auto status = writer->add(frame_);
            return {std::move(status), seconds_since(start)};
        }));
    }
    return {};
}

Status Encoding::finish(const std::atomic<bool>& stop) {
    if (auto before = wait(); !before) return before;
    const auto start = steady_now();
    for (const auto& writer : writers_) {
        if (stop) return {};
        if (auto finished = writer->finish(); !finished) return finished;
    }
    encode_s_ += seconds_since(start);
    return {};
}

Status Encoding::wait() {
    Status outcome;
    for (auto& running : running_) {
        auto done = running.get();
        encode_s_ += done.seconds;
        if (outcome && !done.status) outcome = std::move(done.status);
    }
    running_.clear();
    return outcome;
}

}  // namespace stormcellar::cli

// cli/picture/drawn_frames.h -- pictures that were drawn for a followed loop and will be wanted
// again.
//
// When one grid comes, all frames but one of the next loop are those of the last. A frame is known
// by its grid's file (path, inode, time and size) and by what may differ in the scene from frame to
// frame or from plan to plan: the camera's azimuth, slices, integration and rays.
// Thread contract: one thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

class DrawnFrames {
  public:
    static constexpr std::size_t default_limit = std::size_t{512} << 20U;  // bytes of pixels

    explicit DrawnFrames(std::size_t limit_bytes = default_limit) : limit_(limit_bytes) {}

    using Draw = std::function<Result<render::Image>()>;
    // The picture of the grid's file, drawn if there is none of it yet, and kept as far as there is
    // room. Everything else in the scene must be the same at each call.
    Result<render::Image> frame(const std::filesystem::path& grid, const render::Scene& scene,
                                const Draw& draw);
    // Between two loops: forgets what the last one did not want.
    void next_loop();

    [[nodiscard]] std::size_t count() const { return frames_.size(); }

  private:
    struct Kept {
        render::Image image;
        bool is_wanted = true;
    };
    std::size_t limit_;
    std::size_t bytes_ = 0;
    std::map<std::string, Kept> frames_;
};

}  // namespace stormcellar::cli

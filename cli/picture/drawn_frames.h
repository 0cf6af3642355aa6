// cli/picture/drawn_frames.h -- keeps pictures of a followed loop for reuse.
//
// Each grid that arrives gives a new loop, and all of its frames but one were also in the last
// loop. A picture is identified by the file of its grid (path, inode, time and size) and by the
// parts of the scene that may differ between frames, because the plan or the echo sets them:
// camera, exaggeration, opacity, light, slices, integration and rays.
//
// Threads   One thread at a time.
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
    // Returns the picture of the grid's file with marks; `marks` is any text that differs for
    // different marks. If the picture is not kept, draws it, and keeps it if there is room. All
    // other parts of the scene must be the same in each call.
    Result<render::Image> frame(const std::filesystem::path& grid, const render::Scene& scene,
                                const Draw& draw, const std::string& marks = {});
    // Forgets the pictures that the last loop did not use. Call it between two loops.
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

// web/doors/frames.h -- pictures as `stormcellar frame` draws them (docs/web/pictures.md).
//
//   /frames                        the formats and parameters that there are, as JSON
//   /frames/DOMAIN.png?time=...    a picture; the ending says its format
//
// "time" is the instant of a grid or a later one: the newest grid at or before it is drawn. Without
// it, or with "latest", the newest grid is.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "web/data/frame_pictures.h"
#include "web/doors/picture_answers.h"
#include "web/http/door.h"

namespace stormcellar::web {

class FramesDoor final : public Door {
  public:
    FramesDoor(std::shared_ptr<Grids> grids, std::shared_ptr<FramePictures> pictures)
        : grids_(std::move(grids)), pictures_(std::move(pictures)) {}
    // Pictures that are kept, while their grids are open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // What a request asks for, and the instant of the grids that show it.
    struct Asked {
        std::string domain;
        FrameStyle style;
        UtcTime time;
        std::optional<std::chrono::seconds> max_age;
    };
    [[nodiscard]] Found<Asked> asked(const Request& request) const;
    [[nodiscard]] Answer index(const Request& request) const;

    std::shared_ptr<Grids> grids_;
    std::shared_ptr<FramePictures> pictures_;
};

}  // namespace stormcellar::web

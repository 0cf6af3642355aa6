// web/doors/pictures/frames.h -- pictures as `stormcellar frame` draws them (docs/web/pictures.md).
//
//   /frames                        the formats and parameters, as JSON
//   /frames/DOMAIN.png?time=...    a picture; the ending gives its format
//
// "time" is the instant of a grid or a later one; the newest grid at or before it is drawn. Without
// "time", or with "latest", the newest grid is drawn. A ppi is drawn from the raw volume of the
// newest grid of any moment.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "web/data/pictures/frame_pictures.h"
#include "web/data/pictures/sweep_pictures.h"
#include "web/doors/pictures/picture_answers.h"
#include "web/http/door.h"

namespace stormcellar::web {

class FramesDoor final : public Door {
  public:
    FramesDoor(std::shared_ptr<Grids> grids, std::shared_ptr<FramePictures> pictures,
               std::shared_ptr<SweepPictures> sweeps)
        : grids_(std::move(grids)), pictures_(std::move(pictures)), sweeps_(std::move(sweeps)) {}
    // Answers with a kept picture, if its grids are open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // The picture that a request asks for, and its grids: one of each of these moments at this
    // instant. A picture of a sweep has one grid, whose raw volume is drawn.
    struct Asked {
        std::string domain;
        FrameStyle style;
        std::vector<level2::Moment> moments;
        UtcTime time;
        std::optional<std::chrono::seconds> max_age;

        [[nodiscard]] bool is_of_sweep() const;
    };
    [[nodiscard]] Found<Asked> asked(const Request& request) const;
    // Finds the moments and the newest instant until this one. Returns false if there is no grid.
    [[nodiscard]] bool find_grids(Asked& asked, UtcTime until) const;
    [[nodiscard]] Answer of_sweep(const Request& request, Asked asked);
    [[nodiscard]] Answer index(const Request& request) const;

    std::shared_ptr<Grids> grids_;
    std::shared_ptr<FramePictures> pictures_;
    std::shared_ptr<SweepPictures> sweeps_;
};

}  // namespace stormcellar::web

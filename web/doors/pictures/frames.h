// web/doors/pictures/frames.h -- pictures as `stormcellar frame` draws them (docs/web/pictures.md).
//
//   /frames                        the formats and parameters that there are, as JSON
//   /frames/DOMAIN.png?time=...    a picture; the ending says its format
//
// "time" is the instant of a grid or a later one: the newest grid at or before it is drawn. Without
// it, or with "latest", the newest grid is. A ppi is drawn of the raw volume of the newest grid, of
// whichever moment.
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
    // Pictures that are kept, while their grids are open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // The picture that a request asks for, and the grids that it shows: those of these moments at
    // this instant. A picture of a sweep has one grid, whose raw volume is drawn.
    struct Asked {
        std::string domain;
        FrameStyle style;
        std::vector<level2::Moment> moments;
        UtcTime time;
        std::optional<std::chrono::seconds> max_age;

        [[nodiscard]] bool is_of_sweep() const;
    };
    [[nodiscard]] Found<Asked> asked(const Request& request) const;
    // Takes the moments and the newest instant until this one; false: there is no grid.
    [[nodiscard]] bool find_grids(Asked& asked, UtcTime until) const;
    [[nodiscard]] Answer of_sweep(const Request& request, Asked asked);
    [[nodiscard]] Answer index(const Request& request) const;

    std::shared_ptr<Grids> grids_;
    std::shared_ptr<FramePictures> pictures_;
    std::shared_ptr<SweepPictures> sweeps_;
};

}  // namespace stormcellar::web

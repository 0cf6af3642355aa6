// web/doors/pictures/frames.h -- sends pictures as `stormcellar frame` draws them
// (docs/web/pictures.md).
//
//   /frames                        the formats and parameters, as JSON
//   /frames/DOMAIN.png?time=...    a picture; the ending gives its format
//
// The door draws the newest grid at or before the instant "time". Without "time", or with "latest",
// it draws the newest grid. If panels show several moments, it draws them at the newest instant at
// which every moment has a grid. A ppi is drawn from the raw volume of the newest grid of any
// moment.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "web/data/pictures/frame_pictures.h"
#include "web/data/pictures/sweep_pictures.h"
#include "web/data/storms/rain_totals.h"
#include "web/data/storms/storm_scans.h"
#include "web/doors/pictures/picture_answers.h"
#include "web/http/door.h"

namespace stormcellar::web {

class FramesDoor final : public Door {
  public:
    FramesDoor(std::shared_ptr<Grids> grids, std::shared_ptr<FramePictures> pictures,
               std::shared_ptr<SweepPictures> sweeps, std::shared_ptr<RainTotals> rain,
               std::shared_ptr<StormScans> scans)
        : grids_(std::move(grids)),
          pictures_(std::move(pictures)),
          sweeps_(std::move(sweeps)),
          rain_(std::move(rain)),
          scans_(std::move(scans)) {}
    // Answers with a kept picture if its grids are open, or refuses. Leaves pictures of sweeps to
    // answer().
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // A requested picture. It shows a grid of each moment at `time`. If it shows a sweep, it has
    // one moment, and shows the raw volume of this moment's grid.
    struct Asked {
        std::string domain;
        FrameStyle style;
        std::vector<level2::Moment> moments;
        UtcTime time;
        std::optional<std::chrono::seconds> max_age;

        [[nodiscard]] bool is_of_sweep() const;
    };
    [[nodiscard]] Found<Asked> asked(const Request& request) const;
    // Sets `time` to the newest instant at which every moment has a grid, but not later than
    // `until`. For a sweep, a grid of one of the moments is enough, and this moment remains the
    // only one. Returns false if there is no such instant.
    [[nodiscard]] bool find_grids(Asked& asked, UtcTime until) const;
    [[nodiscard]] Answer of_sweep(const Request& request, Asked asked);
    // Finds the storm cells that the picture marks. They are those of the newest grid at its time.
    [[nodiscard]] Status find_cells(Asked& asked) const;
    // Opens the grids of the picture, or makes its rain total.
    [[nodiscard]] Found<FramePicture> picture_of(Asked& asked) const;
    [[nodiscard]] Answer index(const Request& request) const;

    std::shared_ptr<Grids> grids_;
    std::shared_ptr<FramePictures> pictures_;
    std::shared_ptr<SweepPictures> sweeps_;
    std::shared_ptr<RainTotals> rain_;
    std::shared_ptr<StormScans> scans_;
};

}  // namespace stormcellar::web

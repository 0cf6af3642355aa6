// web/doors/rainviewer/rainviewer.h -- serves the composite reflectivity through the interface of
// RainViewer, so that its clients work here when only their host is changed (docs/web/pictures.md).
//
//   /public/weather-maps.json                             the frames of the last two hours
//   /public/maps.json, /api/maps.json                     the times of the same frames alone
//   /v2/radar/TIME/SIZE/{z}/{x}/{y}/COLOR/OPTIONS.png     a tile of a frame
//   /v2/coverage/0/SIZE/{z}/{x}/{y}/0/0_0.png             black where no beam looked
//   /rainviewer/DOMAIN/public/..., /rainviewer/DOMAIN/v2/...   the same for one domain
//
// TIME is a frame's time in seconds since 1970. SIZE is 256 or 512 pixels. A latitude and a
// longitude with decimal points in place of {x} and {y} give a picture of a tile's size around that
// place. COLOR 0 has gray levels: the reflectivity in dBZ, rounded down, plus 32. COLOR 6 has the
// classes of the Weather Service, and COLOR 1 to 5, 7 and 8 have our smooth table. OPTIONS is
// SMOOTH_SNOW, two digits that are 0 or 1. COLOR 0 is never smoothed, and snow has no colors of its
// own. Tiles end with .png or .webp.
//
// Without a name, the domain is the first mosaic by name, else the first station. A frame is the
// last grid of each ten minutes by the clock; the newest frame changes until its ten minutes are
// over. There are no satellite pictures and no nowcasts; their lists are empty.
//
// Source    The public description of RainViewer's weather maps API 2.0, and of its legacy API.
// Threads   Many threads may use it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "web/data/pictures/map_pictures.h"
#include "web/doors/pictures/picture_answers.h"
#include "web/http/door.h"

namespace stormcellar::web {

// Returns the last time in each ten minutes by the clock, within two hours before the newest time.
// `times` must be ascending.
[[nodiscard]] std::vector<UtcTime> frame_times(const std::vector<UtcTime>& times);

class RainViewerDoor final : public Door {
  public:
    explicit RainViewerDoor(std::shared_ptr<MapPictures> pictures)
        : pictures_(std::move(pictures)) {}
    // Answers with a kept tile, if its grid is open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // A path below the optional /rainviewer/DOMAIN.
    struct Asked {
        std::string domain;                  // empty: there is no grid of reflectivity
        std::string prefix;                  // "/rainviewer/DOMAIN", or empty
        std::vector<std::string_view> path;  // "public" or "v2", and the rest
    };
    [[nodiscard]] Asked asked(const Request& request) const;
    [[nodiscard]] std::string usual_domain() const;
    // Returns the times of the frames in seconds since 1970.
    [[nodiscard]] std::vector<std::int64_t> frames_of(const Asked& asked) const;
    [[nodiscard]] Answer legacy_maps(const Request& request, const Asked& asked) const;
    [[nodiscard]] Answer weather_maps(const Request& request, const Asked& asked) const;
    // Returns the time of the grid that a tile shows.
    [[nodiscard]] Result<UtcTime> time_of(const Asked& asked) const;

    std::shared_ptr<MapPictures> pictures_;
};

}  // namespace stormcellar::web

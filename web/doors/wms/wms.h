// web/doors/wms/wms.h -- the Web Map Service 1.3.0 (OGC 06-042) and 1.1.1 (docs/web/pictures.md):
// 2D products as layers with time.
//
//   /wms?REQUEST=GetCapabilities
//   /wms?REQUEST=GetMap&LAYERS=KTLX:composite.REF&CRS=EPSG:3857&BBOX=...&WIDTH=...&HEIGHT=...
//       &TIME=...
//   /wms?REQUEST=GetFeatureInfo&...&QUERY_LAYERS=...&I=...&J=...
//   /wms?REQUEST=GetLegendGraphic&LAYER=...
//
// /wms/DOMAIN answers these requests, too. Its capabilities have only the layers of that domain.
//
// TIME selects the nearest grid within an hour. Without TIME, the newest grid is used. As the
// standard requires, the header Warning names the instant of the grid unless TIME is exactly this
// instant.
//
// Threads   Many threads may use it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "web/data/pictures/map_pictures.h"
#include "web/doors/wms/request.h"
#include "web/http/door.h"

namespace stormcellar::web {

class WmsDoor final : public Door {
  public:
    explicit WmsDoor(std::shared_ptr<MapPictures> pictures) : pictures_(std::move(pictures)) {}
    // Answers with a kept picture, if its grids are open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // A picture, and the headers Warning for instants that differ from the requested one.
    struct TimedPicture {
        MapPicture picture;
        Fields warnings;
        std::optional<std::chrono::seconds> max_age;  // none: clients must revalidate each use
    };
    using FindGrid = std::function<WmsRead<std::shared_ptr<const OpenGrid>>(
        const std::string& domain, const MapProduct& layer, UtcTime time)>;
    [[nodiscard]] WmsRead<TimedPicture> timed_picture(const WmsMap& map,
                                                      const FindGrid& find) const;
    [[nodiscard]] WmsRead<std::shared_ptr<const OpenGrid>> opened(const std::string& domain,
                                                                  const MapProduct& layer,
                                                                  UtcTime time);
    [[nodiscard]] FindGrid opener();

    [[nodiscard]] Answer capabilities(const Request& request);
    [[nodiscard]] Answer map(const Request& request);
    [[nodiscard]] Answer feature_info(const Request& request);
    [[nodiscard]] Answer legend(const Request& request);

    std::shared_ptr<MapPictures> pictures_;
};

}  // namespace stormcellar::web

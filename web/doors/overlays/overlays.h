// web/doors/overlays/overlays.h -- sends the overlays that [[overlay]] names, for the viewer and
// other maps.
//
//   /overlays                {"overlays": [{"name": "warnings"}]}
//   /overlays/NAME.geojson   web/doors/overlays/served_overlays.h
//
// Threads   Many threads may use it.
// Errors    404 for another path.
#pragma once

#include <memory>

#include "web/doors/overlays/served_overlays.h"
#include "web/http/door.h"

namespace stormcellar::web {

class OverlaysDoor final : public Door {
  public:
    explicit OverlaysDoor(const std::vector<ConfiguredOverlay>& overlays) : overlays_(overlays) {}
    Answer answer(const Request& request) override;

  private:
    ServedOverlays overlays_;
};

}  // namespace stormcellar::web

// web/doors/viewer/viewer.h -- the viewer: a page in which people fly through the weather
// (docs/viewer.md).
//
//   /view/            the page
//   /view/viewer.js   its program, and other files
//
// The page asks this server alone, which its Content-Security-Policy enforces.
//
// Threads   Many threads may use it.
// Errors    404 for files that there are not, and for all if the program was built without it.
#pragma once

#include "web/http/door.h"

namespace stormcellar::web {

class ViewerDoor final : public Door {
  public:
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;
};

}  // namespace stormcellar::web

// web/doors/viewer/viewer.h -- the viewer: a page for flying through the weather (docs/viewer.md).
//
//   /view/            the page
//   /view/viewer.js   its program, and other files
//
// The page sends requests only to this server; its Content-Security-Policy enforces that.
//
// Threads   Many threads may use it.
// Errors    404 for unknown files, and for every file if the program was built without the viewer.
#pragma once

#include "web/http/door.h"

namespace stormcellar::web {

class ViewerDoor final : public Door {
  public:
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;
};

}  // namespace stormcellar::web

// web/doors/api/door.h -- the JSON API below /api/v1.
//
// Threads   Many threads may use it.
// Errors    404 for a path that no operation has, 400 for a parameter that the operation does not
//           have; else as the operation says.
#pragma once

#include "web/doors/api/call.h"
#include "web/http/door.h"

namespace stormcellar::web {

struct ApiOperation;

class ApiDoor final : public Door {
  public:
    explicit ApiDoor(ApiSources sources) : state_(std::move(sources)) {}
    // Answers if the operation has the answer in memory.
    std::optional<Answer> answer_at_once(const Request& request) override;
    // Answers unless that takes a long computation.
    std::optional<Answer> answer_soon(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] Answer answer_of(const Request& request, bool must_be_quick);
    ApiState state_;
};

}  // namespace stormcellar::web

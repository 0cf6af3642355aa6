// web/doors/api_door.h -- the JSON API below /api/v1.
//
// Threads   As Door.
// Errors    404 for a path that is no operation, 400 for a parameter that the operation does not
//           have, else as the operation says.
#pragma once

#include "web/doors/api_call.h"
#include "web/http/door.h"

namespace stormcellar::web {

struct ApiOperation;

class ApiDoor final : public Door {
  public:
    explicit ApiDoor(ApiSources sources) : state_(std::move(sources)) {}
    // Answers with packed grids that are kept, while their grid is open.
    std::optional<Answer> answer_at_once(const Request& request) override;
    // Answers unless that takes a long computation.
    std::optional<Answer> answer_soon(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] Answer answer_of(const Request& request, bool must_be_quick);
    ApiState state_;
};

// Returns the packed form of a grid if it is kept in memory; none otherwise.
[[nodiscard]] std::optional<Answer> packed_at_once(const ApiCall& call);

}  // namespace stormcellar::web

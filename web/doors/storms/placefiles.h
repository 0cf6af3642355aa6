// web/doors/storms/placefiles.h -- sends placefiles, which GR2Analyst, GRLevel3, supercell-wx and
// others draw and request again each minute.
//
//   /placefiles/cells.txt?area=   storm cells with their tracks and forecasts
//
// Threads   Many threads may use it.
// Errors    404 for another name or an unknown area, 400 for a parameter that makes no sense.
#pragma once

#include <memory>

#include "web/doors/storms/storm_answers.h"
#include "web/http/door.h"

namespace stormcellar::web {

class PlacefilesDoor final : public Door {
  public:
    explicit PlacefilesDoor(std::shared_ptr<const StormAnswers> storms)
        : storms_(std::move(storms)) {}
    std::optional<Answer> answer_soon(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    [[nodiscard]] std::optional<Answer> answer_of(const Request& request, bool must_be_quick);
    std::shared_ptr<const StormAnswers> storms_;
};

}  // namespace stormcellar::web

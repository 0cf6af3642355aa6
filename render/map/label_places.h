// render/map/label_places.h -- remembers which parts of a picture are taken, so that texts do not
// overlap.
//
// Threads   One thread at a time.
#pragma once

#include <algorithm>
#include <vector>

#include "render/image/canvas.h"

namespace stormcellar::render {

class LabelPlaces {
  public:
    // A box that is not wholly inside the frame is never free.
    explicit LabelPlaces(const Rect& frame) : frame_(frame) {}

    [[nodiscard]] bool is_free(const Rect& box) const {
        const bool inside = box.x >= frame_.x && box.y >= frame_.y &&
                            box.right() <= frame_.right() && box.bottom() <= frame_.bottom();
        return inside && std::none_of(taken_.begin(), taken_.end(), [&](const Rect& other) {
                   return box.x < other.right() && other.x < box.right() &&
                          box.y < other.bottom() && other.y < box.bottom();
               });
    }
    void take(const Rect& box) { taken_.push_back(box); }
    // Takes the box if it is free. Returns false if it is not.
    bool claim(const Rect& box) {
        if (!is_free(box)) return false;
        take(box);
        return true;
    }

  private:
    Rect frame_;
    std::vector<Rect> taken_;
};

}  // namespace stormcellar::render

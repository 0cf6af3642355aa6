// render/map/mark_text.h -- a text on the map, at a place that no other text or mark has.
//
// Units     Pixels of the picture.
// Threads   One thread at a time.
#pragma once

#include <optional>
#include <string>

#include "render/image/canvas.h"
#include "render/map/label_places.h"

namespace stormcellar::render {

struct MarkText {
    Rect box;  // contains the text
    Point left_baseline;
    double size = 0;
    bool bold = false;
    Rgba8 color{};
    std::string text;
};

struct MarkTextLook {
    double size = 10;
    bool bold = false;
    Rgba8 color{};
    double halo = 1;  // width of the halo, which belongs to the box
};

// Takes the place of a text if it is free, and returns the text. Returns none if it is not free.
[[nodiscard]] std::optional<MarkText> claim_text(LabelPlaces& places, const Fonts& fonts,
                                                 const std::string& text, Point left_baseline,
                                                 const MarkTextLook& look);

}  // namespace stormcellar::render

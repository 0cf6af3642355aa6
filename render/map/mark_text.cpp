#include "render/map/mark_text.h"

#include <cmath>

namespace stormcellar::render {

std::optional<MarkText> claim_text(LabelPlaces& places, const Fonts& fonts, const std::string& text,
                                   Point left_baseline, const MarkTextLook& look) {
    // The text will be drawn on whole pixels.
    left_baseline = {std::nearbyint(left_baseline.x), std::nearbyint(left_baseline.y)};
    const Rect box = {left_baseline.x - look.halo, left_baseline.y - 0.8 * look.size - look.halo,
                      fonts.width(text, look.size, look.bold) + 2 * look.halo,
                      1.05 * look.size + 2 * look.halo};
    if (!places.claim(box)) return std::nullopt;
    return MarkText{box, left_baseline, look.size, look.bold, look.color, text};
}

}  // namespace stormcellar::render

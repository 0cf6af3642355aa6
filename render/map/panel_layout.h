// render/map/panel_layout.h -- the places of the panels in a picture, and the texts around them.
//
// Threads   Pure functions; Fonts may be used by one thread at a time.
#pragma once

#include <span>
#include <vector>

#include "render/map/labels.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct PanelLayout {
    std::vector<Rect> pictures;  // in whole pixels, in the order of the panels
    double scale = 1;            // of lines and letters in them
    LabelLayout labels;          // around all panels; without the place of a single picture
};

// Lays out panels with these legends in a picture of the scene's size and theme. `facts` and
// `picture` give the texts of the header and the footer. Errors: bad_argument if the picture is too
// small.
[[nodiscard]] Result<PanelLayout> lay_out_panels(const Fonts& fonts, const Scene& scene,
                                                 const FrameFacts& facts, const DrawnFacts& picture,
                                                 std::span<const Legend> legends);

// Returns how many panels are in a row, so that they are as nearly square as possible.
[[nodiscard]] int panels_in_a_row(int count, int width, int height);

}  // namespace stormcellar::render

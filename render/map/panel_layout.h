// render/map/panel_layout.h -- places the panels in a picture, and the texts around them.
//
// Threads   Pure functions. One thread at a time may use a Fonts.
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
    double scale = 1;            // of lines and letters in the panels
    LabelLayout labels;          // around all panels; `left` to `height` are not used
};

// Lays out panels with these legends, in a picture that has the scene's size and theme. `facts` and
// `picture` give the texts of the header and the footer. Errors: bad_argument if the picture is too
// small.
[[nodiscard]] Result<PanelLayout> lay_out_panels(const Fonts& fonts, const Scene& scene,
                                                 const FrameFacts& facts, const DrawnFacts& picture,
                                                 std::span<const Legend> legends);

// Returns how many panels to put in a row. With this number, panels are as nearly square as
// possible.
[[nodiscard]] int panels_in_a_row(int count, int width, int height);

}  // namespace stormcellar::render

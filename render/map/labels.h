// render/map/labels.h -- the frame round the picture: title, time, colour bar, legend, what was
// done.
//
// The picture lies below a header and above a footer; a panel at its right holds the colour bar
// and the legend. Layout and drawing are apart, so that tests can see that nothing overlaps.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "render/canvas.h"
#include "render/render.h"

namespace stormcellar::render {

// Labels need room: smaller pictures are drawn without them, or not at all.
inline constexpr int smallest_labelled_width = 400;
inline constexpr int smallest_labelled_height = 300;

struct LabelText {
    Rect box;  // the text lies inside
    double baseline = 0;
    double size = 0;
    bool bold = false;
    Rgba8 colour{};
    std::string text;
};

struct LabelBlock {
    Rect box;
    Rgba8 colour{};
    bool hatched = false;
};

struct LabelLayout {
    double scale = 1;                              // of text and lines; 1 for 796 x 532 pixels
    int left = 0, top = 0, width = 0, height = 0;  // the picture
    std::vector<LabelBlock> blocks;                // colour bar and legend
    std::vector<LabelText> texts;
};

// bad_argument when the scene's picture is too small for labels.
[[nodiscard]] Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene,
                                                 const FrameFacts& facts,
                                                 double drawn_ring_spacing_m);

void draw_labels(Canvas& canvas, const Fonts& fonts, const LabelLayout& layout);

}  // namespace stormcellar::render

// render/map/labels.h -- the frame round the picture: title, time, colour bar, legend, what was
// done.
//
// The picture lies below a header and above a footer; a panel at its right holds the colour bar
// and the legend. Where the picture lies depends on the scene alone, so that it keeps its place
// from frame to frame of a loop. Layout and drawing are apart, so that tests can see that nothing
// overlaps. Text that has no room becomes smaller, down to three quarters, then ends in an
// ellipsis. The colour bar: a stepped table has classes of one height, each labelled at its lower
// bound; one with blends has an axis regular in value, labelled at round values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/map/coverage.h"
#include "render/map/legend.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/frame_facts.h"

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

// What the labels say of the picture beside the facts of its grid.
struct PictureFacts {
    Legend legend;
    double ring_spacing_m = 50e3;  // as drawn
    std::optional<Coverage> coverage;
};

// bad_argument when the scene's picture is too small for labels.
[[nodiscard]] Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene,
                                                 const FrameFacts& facts,
                                                 const PictureFacts& picture);

void draw_labels(Canvas& canvas, const Fonts& fonts, const LabelLayout& layout);

// "42 s", "3 min 12 s"
[[nodiscard]] std::string duration_text(std::chrono::seconds duration);

}  // namespace stormcellar::render

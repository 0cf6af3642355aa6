// render/map/labels.h -- the frame around the picture: title, time, color bar, legend and notes.
//
// The picture lies below a header and above a footer; a panel at its right holds the color bar and
// the legend. The place of the picture depends on the scene alone, so that it does not move from
// frame to frame of a loop. Layout and drawing are separate, so that tests can check that nothing
// overlaps. Text without enough room becomes smaller, down to three quarters, and then ends in an
// ellipsis. In the color bar, a stepped table has classes of equal height, labeled at their lower
// bounds; a table with blends has an axis that is linear in the value, labeled at round values.
//
// Threads   Plain values and pure functions; Fonts may be used by one thread at a time.
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

// Labels need room: smaller pictures are drawn without labels, or not at all.
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
    std::vector<LabelBlock> blocks;                // color bar and legend
    std::vector<LabelText> texts;
};

// What the labels say about the picture beside the facts of its grid.
struct PictureFacts {
    Legend legend;
    double ring_spacing_m = 50e3;  // as drawn
    std::optional<Coverage> coverage;
};

// Lays out the labels. Errors: bad_argument if the picture of the scene is too small for labels.
[[nodiscard]] Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene,
                                                 const FrameFacts& facts,
                                                 const PictureFacts& picture);

void draw_labels(Canvas& canvas, const Fonts& fonts, const LabelLayout& layout);

// Returns "42 s" or "3 min 12 s".
[[nodiscard]] std::string duration_text(std::chrono::seconds duration);

}  // namespace stormcellar::render

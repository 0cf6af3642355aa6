// render/map/labels.h -- lays out what is around the picture: title, time, color bar, legend and
// notes.
//
// The picture is between a header and a footer. The color bar and the legend are at its right or
// below it (render/map/picture_space.h). The place of the picture depends only on the scene, so
// that it does not move from frame to frame of a loop. Layout and drawing are separate, so that
// tests can check that nothing overlaps. A text without enough room becomes smaller, down to three
// quarters, and then ends in an ellipsis.
//
// Threads   Plain values and pure functions. One thread at a time may use a Fonts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/map/coverage.h"
#include "render/map/label_builder.h"
#include "render/map/legend.h"
#include "render/map/picture_space.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/frame_facts.h"

namespace stormcellar::render {

// Labels need room. A smaller picture is drawn without labels or not at all.
inline constexpr int smallest_labelled_width = 400;
inline constexpr int smallest_labelled_height = 300;

struct LabelLayout : LabelParts {
    double scale = 1;                              // of text and lines; 1 for 796 x 532 pixels
    int left = 0, top = 0, width = 0, height = 0;  // the picture
    // For a section: the place of the small map that shows its line.
    std::optional<Rect> inset;
    const Shades* shades = &shades::dark;
};

// Facts about the picture that its labels show, besides the facts about its grid.
struct DrawnFacts {
    Legend legend;
    double ring_spacing_m = 50e3;  // the spacing that is drawn
    std::optional<Coverage> coverage;
    std::string sweep = {};  // for a ppi: the line about the sweep
    std::string hail = {};   // the error of the largest hail (render/frame/hail_text.h)
    std::vector<std::string> marks = {};  // lines about the storm cells and shapes that are drawn
};

// Lays out the labels. Errors: bad_argument if the picture of the scene is too small for labels.
[[nodiscard]] Result<LabelLayout> lay_out_labels(const Fonts& fonts, const Scene& scene,
                                                 const FrameFacts& facts,
                                                 const DrawnFacts& picture);

// The texts of a header: the product, the place and the time.
struct HeaderTexts {
    std::string title, product, time, local_time, warnings;
};
[[nodiscard]] HeaderTexts header_of(const FrameFacts& facts, const std::string& product);
// Returns the title of the product. For the storm-relative velocity, adds the motion of the storm.
[[nodiscard]] std::string product_line(const Scene& scene, const FrameFacts& facts);
// Places the header of a picture of this shape. It is as wide as the picture (`width`, in pixels).
void lay_out_header(LabelBuilder& builder, PictureShape shape, double width,
                    const HeaderTexts& texts);
struct FooterTexts {
    std::string view, age, seen, credit;
};
[[nodiscard]] FooterTexts footer_of(const Scene& scene, const FrameFacts& facts,
                                    const DrawnFacts& picture);
// Places the lines of small print at the bottom of a picture of this size. Two texts begin at the
// left, and two end at the right.
void lay_out_footer(LabelBuilder& builder, double width, double height, const FooterTexts& texts);

void draw_labels(Canvas& canvas, const Fonts& fonts, const LabelLayout& layout);

// Returns a duration such as "42 s" or "3 min 12 s".
[[nodiscard]] std::string duration_text(std::chrono::seconds duration);

}  // namespace stormcellar::render

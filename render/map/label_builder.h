// render/map/label_builder.h -- puts texts and blocks of color into a layout of labels.
//
// Sizes of text are for scale 1. Places, widths and boxes are in pixels.
//
// Threads   One thread at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/image/shades.h"

namespace stormcellar::render {

struct LabelText {
    Rect box;  // contains the text
    double baseline = 0;
    double size = 0;
    bool bold = false;
    Rgba8 color{};
    std::string text;
};

struct LabelBlock {
    Rect box;
    Rgba8 color{};
    std::optional<Rgba8> lines = {};  // the block is hatched with lines of this color
};

// All that is drawn around a picture.
struct LabelParts {
    std::vector<LabelBlock> blocks;  // color bars and legends
    // Around color bars, because their ends may have the page's color.
    std::vector<Rect> outlines;
    std::vector<LabelText> texts;
};

struct LabelStyle {
    double size = 10;  // at scale 1
    bool bold = false;
    Rgba8 color{};
};

// The part of a text that is at x.
enum class Align { left, middle, right };

class LabelBuilder {
  public:
    // All arguments must outlive the builder.
    LabelBuilder(const Fonts& fonts, const Shades& shades, double scale, LabelParts& parts)
        : fonts_(fonts), shades_(shades), scale_(scale), parts_(parts) {}

    [[nodiscard]] double scaled(double length) const { return length * scale_; }
    [[nodiscard]] const Shades& shades() const { return shades_; }
    // Returns the width in pixels of a text at its full size.
    [[nodiscard]] double width_of(const std::string& text, const LabelStyle& style) const {
        return fonts_.width(text, scaled(style.size), style.bold);
    }
    [[nodiscard]] LabelStyle plain(double size) const { return {size, false, shades_.text}; }
    [[nodiscard]] LabelStyle quiet(double size) const { return {size, false, shades_.quiet_text}; }
    [[nodiscard]] LabelStyle strong(double size) const { return {size, true, shades_.text}; }

    // Places a text. If it does not fit into `room` pixels, makes it smaller, down to three
    // quarters; if it still does not fit, cuts it and adds an ellipsis. Returns the width of the
    // placed text; 0 if the text is empty or there is no room at all.
    double put(std::string text, double x, double baseline, double room, const LabelStyle& style,
               Align align = Align::left);
    void block(const Rect& box, Rgba8 color, std::optional<Rgba8> lines = {}) {
        parts_.blocks.push_back({box, color, lines});
    }
    void outline(const Rect& box) { parts_.outlines.push_back(box); }

  private:
    [[nodiscard]] std::string shortened(std::string text, double size, bool bold,
                                        double room) const;

    const Fonts& fonts_;
    const Shades& shades_;
    double scale_;
    LabelParts& parts_;
};

}  // namespace stormcellar::render

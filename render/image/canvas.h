// render/image/canvas.h -- draws lines, areas and text on an Image, with Cairo.
//
// The font is DejaVu Sans, regular and bold. The program reads the font's files itself, so that a
// picture is the same on every machine.
//
// Threads   One thread at a time may use a Canvas. The same holds for a Fonts.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/letter_halos.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

// These names are Cairo's. Declaring them here keeps Cairo's headers out of ours.
// NOLINTBEGIN(bugprone-reserved-identifier)
struct _cairo;
struct _cairo_surface;
struct _cairo_font_face;
// NOLINTEND(bugprone-reserved-identifier)

namespace stormcellar::render {

struct Rect {
    double x = 0, y = 0, width = 0, height = 0;

    [[nodiscard]] double right() const { return x + width; }
    [[nodiscard]] double bottom() const { return y + height; }
};

struct Point {
    double x = 0, y = 0;
};

class Fonts {
  public:
    // Loads the fonts. Errors: not_found if none of the usual directories has the font's files; the
    // message names the package.
    static Result<Fonts> load();

    // Returns how far a text of this size (in pixels) moves the pen. The text must be ASCII or
    // Latin-1, in UTF-8.
    [[nodiscard]] double width(std::string_view text, double size, bool bold) const;
    [[nodiscard]] _cairo_font_face* face(bool bold) const {
        return bold ? bold_.get() : regular_.get();
    }

  private:
    using Face = std::shared_ptr<_cairo_font_face>;
    Face regular_, bold_;
};

class Canvas {
  public:
    // Makes an opaque picture of one color.
    Canvas(int width, int height, Rgba8 fill);
    explicit Canvas(const Image& opaque);

    // Colors may be translucent.
    void fill(const Rect& rect, Rgba8 color);
    void fill(const std::vector<Point>& polygon, Rgba8 color);
    void line(const std::vector<Point>& points, double line_width, Rgba8 color, bool closed);
    // Adds lines to the path. draw_path() draws all lines of the path as one, so that a translucent
    // color does not add up where lines cross.
    void add_to_path(const std::vector<Point>& points, Point offset = {});
    void draw_path(double line_width, Rgba8 color);  // draws the path and begins a new one
    // Restrict drawing to a polygon, or to the part that two polygons share. This holds until the
    // next clip or unclip().
    void clip(const std::vector<Point>& polygon);
    void clip_both(const std::vector<Point>& one, const std::vector<Point>& other);
    void unclip();
    // Draws a text. Its baseline begins at `left_baseline`. If the halo color has an alpha above 0,
    // letters get an outline, so that they are readable on anything.
    void text(const Fonts& fonts, std::string_view text, Point left_baseline, double size,
              bool bold, Rgba8 color, Rgba8 halo = {0, 0, 0, 0});

    void place(const Image& image, int left, int top);
    [[nodiscard]] Image image() const;

  private:
    struct Context {
        void operator()(_cairo* context) const;
    };
    struct Surface {
        void operator()(_cairo_surface* surface) const;
    };
    void trace(const std::vector<Point>& points) const;

    int width_, height_;
    std::unique_ptr<_cairo_surface, Surface> surface_;
    std::unique_ptr<_cairo, Context> context_;
    LetterHalos halos_;
};

}  // namespace stormcellar::render

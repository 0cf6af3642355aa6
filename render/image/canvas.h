// render/image/canvas.h -- draws lines, areas and text on an Image, with Cairo.
//
// The font is DejaVu Sans, regular and bold. The program reads its files, so that a picture is the
// same on every machine.
//
// Threads   A Canvas, and a Fonts, may be used by one thread at a time.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/letter_halos.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

// These names are Cairo's, so that its headers stay out of ours.
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
    // Loads the fonts. Errors: not_found if the usual directories do not hold the font's files; the
    // message names the package.
    static Result<Fonts> load();

    // Returns how far text of this size (pixels) moves the pen. The text is ASCII or Latin-1, in
    // UTF-8.
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
    // Draws many lines as one, so that a translucent color does not add up where they cross.
    void add_to_path(const std::vector<Point>& points, Point offset = {});
    void draw_path(double line_width, Rgba8 color);  // draws the path and begins a new one
    // Restrict drawing to a polygon, or to the common part of two, until the next clip or unclip().
    void clip(const std::vector<Point>& polygon);
    void clip_both(const std::vector<Point>& one, const std::vector<Point>& other);
    void unclip();
    // Draws a text that starts at the left end of its baseline. If the halo color has an alpha
    // above 0, the letters get an outline, so that they are readable on anything.
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

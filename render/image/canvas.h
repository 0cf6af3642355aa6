// render/image/canvas.h -- lines, areas and text on an Image, by Cairo.
//
// The font is DejaVu Sans, regular and bold, read from its files, so that a picture is the same
// wherever it is drawn.
// Thread contract: one Canvas, one thread; Fonts may be used by one thread at a time.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

// Cairo's own names, so that its headers stay out of ours.
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
    // not_found, naming the package, when the font's files are in none of the usual directories.
    static Result<Fonts> load();

    // How far text of this size (pixels) moves the pen; ASCII and Latin-1 in UTF-8.
    [[nodiscard]] double width(std::string_view text, double size, bool bold) const;

  private:
    friend class Canvas;
    using Face = std::shared_ptr<_cairo_font_face>;
    Face regular_, bold_;
};

class Canvas {
  public:
    // An opaque picture of one colour.
    Canvas(int width, int height, Rgba8 fill);
    explicit Canvas(const Image& opaque);

    // Colours may be translucent.
    void fill(const Rect& rect, Rgba8 colour);
    void fill(const std::vector<Point>& polygon, Rgba8 colour);
    void line(const std::vector<Point>& points, double line_width, Rgba8 colour, bool closed);
    // Many lines drawn as one: where they cross, a translucent colour does not show twice.
    void add_to_path(const std::vector<Point>& points, Point offset = {});
    void draw_path(double line_width, Rgba8 colour);  // and begins a new one
    // Until the next clip or unclip, only what lies inside is drawn.
    void clip(const std::vector<Point>& polygon);
    void clip_both(const std::vector<Point>& one, const std::vector<Point>& other);
    void unclip();
    // `left` is where the text starts, `baseline` its line. With a halo colour of alpha > 0 the
    // text gets an outline, to stand on anything.
    void text(const Fonts& fonts, std::string_view text, Point left_baseline, double size,
              bool bold, Rgba8 colour, Rgba8 halo = {0, 0, 0, 0});

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
};

}  // namespace stormcellar::render

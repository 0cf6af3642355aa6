// render/wind/wind_page.h -- provides the page on which wind profiles are drawn: facts, sizes and
// text.
//
// Threads   A WindCanvas may be used by one thread at a time.
#pragma once

#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/image/shades.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/render/units.h"
#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::render {

struct WindPage {
    int width = 900, height = 900;  // at least 16
    Theme theme = Theme::dark;
    Units units;
    std::string station;            // ICAO
    double antenna_altitude_m = 0;  // above sea level
    std::string method;             // how the wind was measured, for the line below the title
};

// The wind profile of one volume.
struct WindColumn {
    UtcTime time;
    std::vector<retrieve::WindLayer> layers;
};

// A canvas with the fonts, colors and sizes of the page. Sizes are in pixels of a page that is 800
// wide.
class WindCanvas {
  public:
    WindCanvas(const WindPage& page, const Fonts& fonts);

    // Returns the size that a pixel of a page 800 wide has on this page.
    [[nodiscard]] static double scale_of(const WindPage& page);
    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] const Shades& shades() const { return shades_; }
    [[nodiscard]] Canvas& canvas() { return canvas_; }

    struct Style {
        double size = 11;
        bool is_bold = false;
        bool is_quiet = false;
        double share = 0;   // the part of the text that is left of the point
        double room = 1e9;  // a longer text gets smaller letters
        bool has_halo = false;
    };
    // Writes text with its baseline at a point. Returns its right end.
    double write(const std::string& text, Point baseline, const Style& style);
    // Writes the title and the line below it.
    void write_title(const std::string& title, const std::string& below);
    void disc(Point middle, double radius, Rgba8 color);

  private:
    double scale_;
    const Shades& shades_;
    const Fonts& fonts_;
    Canvas canvas_;
    double width_;
};

// Returns "1999-05-03 23:56 UTC".
[[nodiscard]] std::string minute_text(UtcTime time);

}  // namespace stormcellar::render

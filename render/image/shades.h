// render/image/shades.h -- the quiet colors behind and around the echo, for each theme.
//
// The colors of the ground are nearly gray. Their lightness is far from that of echo, so that no
// ground looks like a reflectivity. Letters have a contrast of 4.5 or more against every background
// but echo; over echo, they have this contrast against their halo. Lines of the map have less
// contrast, so that they stay behind the echo (tests/render/shades_test.cpp has the figures).
#pragma once

#include "stormcellar/render/image.h"
#include "stormcellar/render/theme.h"

namespace stormcellar::render {

// The colors of ground, by how the air over it was seen. Ground under air that was not seen has
// thin diagonal lines over it.
struct GroundShades {
    Rgba8 seen;        // seen from low down
    Rgba8 seen_aloft;  // seen only from higher up
    Rgba8 not_seen;
    Rgba8 beyond;  // ground outside the grid
};

struct Shades {
    Rgba8 page;
    GroundShades land, water;
    Rgba8 hatch;  // the lines over ground that was not seen
    Rgba8 haze;   // for air that was not seen
    Rgba8 border, ring;
    Rgba8 county, state, country, coast, interstate, highway;
    Rgba8 casing;  // a darker or lighter edge between lines and echo
    Rgba8 city, small_city;
    Rgba8 text, quiet_text, warning_text;
    Rgba8 halo;  // around letters and marks
};

namespace shades {

inline constexpr Shades dark = {
    .page = {11, 14, 19, 255},
    .land = {{40, 44, 50, 255}, {29, 32, 37, 255}, {23, 25, 29, 255}, {25, 28, 33, 255}},
    .water = {{22, 31, 46, 255}, {17, 24, 36, 255}, {15, 20, 28, 255}, {14, 19, 29, 255}},
    .hatch = {78, 82, 92, 255},
    .haze = {104, 110, 122, 255},
    .border = {120, 130, 146, 255},
    .ring = {160, 174, 194, 110},
    .county = {118, 124, 132, 130},
    .state = {164, 170, 180, 235},
    .country = {200, 203, 208, 245},
    .coast = {138, 158, 182, 240},
    .interstate = {164, 132, 104, 190},
    .highway = {150, 126, 104, 150},
    .casing = {8, 10, 14, 90},
    .city = {232, 234, 238, 255},
    .small_city = {200, 205, 212, 255},
    .text = {234, 238, 243, 255},
    .quiet_text = {166, 177, 192, 255},
    .warning_text = {255, 190, 90, 255},
    .halo = {8, 10, 14, 225},
};

inline constexpr Shades light = {
    .page = {250, 250, 248, 255},
    .land = {{236, 234, 228, 255},
             {219, 217, 211, 255},
             {211, 209, 204, 255},
             {243, 242, 238, 255}},
    .water = {{212, 224, 235, 255},
              {196, 208, 220, 255},
              {190, 201, 212, 255},
              {226, 234, 241, 255}},
    .hatch = {158, 160, 164, 255},
    .haze = {150, 154, 162, 255},
    .border = {112, 118, 128, 255},
    .ring = {70, 82, 100, 120},
    .county = {124, 124, 124, 120},
    .state = {88, 90, 98, 235},
    .country = {52, 54, 60, 245},
    .coast = {58, 92, 128, 240},
    .interstate = {146, 98, 62, 180},
    .highway = {146, 110, 80, 140},
    .casing = {255, 255, 255, 90},
    .city = {20, 22, 28, 255},
    .small_city = {52, 56, 64, 255},
    .text = {22, 26, 32, 255},
    .quiet_text = {70, 77, 88, 255},
    .warning_text = {146, 60, 0, 255},
    .halo = {255, 255, 255, 225},
};

}  // namespace shades

[[nodiscard]] const Shades& shades_of(Theme theme);

// Returns a mix of two colors, with the alpha of `one`. A share of 0 gives the color of `one`, and
// a share of 1 that of `other`.
[[nodiscard]] Rgba8 mixed_between(Rgba8 one, Rgba8 other, double share);
// Returns the same as mixed_between(), but faster for shares of 0 and 1, which nearly all pixels
// have.
[[nodiscard]] inline Rgba8 mixed(Rgba8 one, Rgba8 other, double share) {
    if (share == 0) return one;
    if (share == 1) return {other[0], other[1], other[2], one[3]};
    return mixed_between(one, other, share);
}

// Returns the color of ground that was not seen, with thin diagonal lines, at a pixel of the whole
// picture. The distance between lines is `scale` times the usual distance.
[[nodiscard]] Rgba8 hatched(Rgba8 ground, Rgba8 lines, int x, int y, double scale);

}  // namespace stormcellar::render

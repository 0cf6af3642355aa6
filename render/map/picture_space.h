// render/map/picture_space.h -- divides a picture of a given size into title, map, color bar and
// small print.
//
// There are three shapes. A wide picture has its color bar at the right. Square and tall pictures
// have their color bar below, so that the map has the whole width. A tall picture also has more
// lines in its title. All lengths grow with the size of the picture.
//
// Threads   Plain values and a pure function.
#pragma once

namespace stormcellar::render {

enum class PictureShape { wide, square, tall };

// Text is never smaller than at this scale, not even in a picture of several maps
// (render/map/panel_layout.h).
inline constexpr double least_text_scale = 0.85;

// Lengths are in pixels.
struct PictureSpace {
    PictureShape shape = PictureShape::wide;
    double scale = 1;  // of text and lines; 1 for a wide picture of 796 x 532 pixels
    int header = 0, footer = 0;
    int panel = 0;  // width of the color bar at the right; 0: none
    int band = 0;   // height of the color bar below the map; 0: none
};

[[nodiscard]] PictureSpace space_of(int width, int height);

}  // namespace stormcellar::render

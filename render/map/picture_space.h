// render/map/picture_space.h -- divides a picture of a given size into title, map, colors and small
// print.
//
// There are three shapes. A wide picture has its colors at the right. Square and tall pictures have
// their colors below, so that the map has the whole width. A tall picture also has more lines in
// its title. All lengths grow with the size of the picture.
//
// Threads   Plain values and a pure function.
#pragma once

namespace stormcellar::render {

enum class PictureShape { wide, square, tall };

// Letters are never smaller than at this scale, not even in panels.
inline constexpr double least_text_scale = 0.85;

// Lengths are in pixels.
struct PictureSpace {
    PictureShape shape = PictureShape::wide;
    double scale = 1;  // of text and lines; 1 for 796 x 532 pixels
    int header = 0, footer = 0;
    int panel = 0;  // width of the colors at the right; 0: none
    int band = 0;   // height of the colors below the map; 0: none
};

[[nodiscard]] PictureSpace space_of(int width, int height);

}  // namespace stormcellar::render

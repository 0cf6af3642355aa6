// render/map/picture_space.h -- how a picture of a size is divided: title, map, colors, small
// print.
//
// There are three shapes. A wide picture has its colors at the right. A square one and a tall one
// have them below, so that the map has the whole width; a tall one has more lines in its title.
// All lengths grow with the picture.
//
// Threads   Plain values and a pure function.
#pragma once

namespace stormcellar::render {

enum class PictureShape { wide, square, tall };

// Letters get no smaller than at this scale, in panels neither.
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

// render/image/letter_halos.h -- the outlines of letters, which make the halo of a text.
//
// An outline is a letter that is drawn with a round pen. Drawing takes far longer than copying, and
// a map repeats the same letters. So each letter of a font and a size is drawn only once. Letters
// are at whole pixels, so that a copy equals a drawn letter to the bit. If the outlines of two
// letters meet in a pixel, they cover it from two sides, so their shares are added.
//
// Units     Pixels.
// Threads   One thread at a time.
// Errors    Letters that Cairo cannot draw for lack of memory are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

// These names are Cairo's. Declaring them here keeps Cairo's headers out of ours.
// NOLINTBEGIN(bugprone-reserved-identifier)
struct _cairo;
struct _cairo_scaled_font;
// NOLINTEND(bugprone-reserved-identifier)

namespace stormcellar::render {

// A mask. It has the share of each pixel that is covered, 0 to 255, row by row from the top.
struct CoverMask {
    int left = 0, top = 0;  // of the mask, relative to the letter or to the picture
    int width = 0, height = 0;
    int stride = 0;  // bytes from row to row
    std::vector<std::uint8_t> cover;
};

class LetterHalos {
  public:
    // Returns the outline of a text, drawn with a pen of this width. The text begins at x on its
    // baseline y. `bold` and `size` say which font of the canvas the text has.
    [[nodiscard]] CoverMask halo_of(_cairo_scaled_font* font, bool bold, double size,
                                    const char* text, int x, int y, double pen);

  private:
    using Key = std::tuple<bool, double, unsigned long>;  // bold, size, number of the glyph
    const CoverMask& letter(_cairo_scaled_font* font, const Key& key, double pen);

    std::map<Key, CoverMask> letters_;
};

// Paints with the context's source the part of the picture that the mask covers.
void paint_cover(_cairo* context, CoverMask& mask);

}  // namespace stormcellar::render

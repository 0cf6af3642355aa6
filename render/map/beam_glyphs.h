// render/map/beam_glyphs.h -- glyphs of the wind of a sweep. They show the wind along the beam, and
// that the wind across the beam is unknown.
//
// A glyph is at a gate with a velocity. A line along the beam starts at the gate and ends, with a
// head, where the air goes; its length is proportional to the speed along the beam. A faint disc
// across the beam represents the rest of the wind, which one radar cannot see. So no glyph is an
// arrow of the wind. Speeds below `calm_mps` have a dot and no head. Gates that are ambiguous,
// range folded, without echo or not seen have no glyph.
//
// The glyphs are on a lattice of the picture, so they stay in place from frame to frame of a loop.
// A glyph shows the one gate under the center of its disc: values are not mixed. Glyphs that would
// overlap an earlier glyph or a mark of the map are left out.
//
// Accuracy  Directions are those of the beam over the ground of the map to 0.5 degrees, lengths are
//           exact (tests/render/beam_glyphs_test.cpp). A line has its full length whatever the
//           elevation of the beam: the picture from above does not shorten it.
// Limits    Velocities as measured (VEL) may be folded; then the heads are wrong, too.
// Threads   Pure functions, except that they draw on the canvas.
#pragma once

#include <vector>

#include "render/map/map_marks.h"
#include "stormcellar/grid/sweep_lookup.h"

namespace stormcellar::render {

struct BeamGlyph {
    static constexpr double calm_mps = 1;

    Point gate;           // the center of the disc, in pixels of the picture
    Point along;          // unit vector of the picture: away from the radar
    Point tip;            // the end of the line; `gate` for a calm
    float speed_mps = 0;  // away from the radar; negative: toward it
};

// Returns the length of a line in pixels, for lines and text of this scale.
[[nodiscard]] double glyph_length(double speed_mps, double scale);

// Plans the glyphs of a map, from the top down and from left to right.
[[nodiscard]] std::vector<BeamGlyph> plan_beam_glyphs(const grid::SweepLookup& sweep,
                                                      const MapLines& lines, const MapMarks& marks);
void draw_beam_glyphs(Canvas& canvas, const std::vector<BeamGlyph>& glyphs, const MapLines& lines);

// The key of the glyphs: the length of a round speed, and the meaning of the disc.
struct GlyphKey {
    double speed_mps = 0;
    std::string along, across;  // texts
};
[[nodiscard]] GlyphKey glyph_key(const Units& units);
// Returns the width and the height of the key in pixels.
[[nodiscard]] Point size_of_glyph_key(const Fonts& fonts, const Units& units, double scale);
// Draws the key in the box that the marks keep for it.
void draw_glyph_key(Canvas& canvas, const Fonts& fonts, const MapLines& lines, const Rect& box);

}  // namespace stormcellar::render

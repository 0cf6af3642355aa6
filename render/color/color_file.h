// render/color/color_file.h -- reads color tables of users: TOML files and .pal files of GRLevelX.
//
// TOML (docs/rendering.md has an example):
//   name, unit, moment = "REF"   All optional. The moment sets the unit and the opacity.
//   stepped = true|false         true: classes; false, the default: colors that blend to the color
//                               of the next point.
//   end                          Where the color bar ends.
//   range_folded                 Color of range folded cells.
//   [[point]]                    At least 2 (1 if stepped), with rising values:
//     value, color = "#rrggbb", "#rrggbbaa", [r, g, b] or [r, g, b, a]
//     until                      The color to which this point blends, instead of the next point's
//                                color.
//     opacity_per_km             For volumes: the optical depth, in all points or in none. If none
//                                has it, extinction_of_colors() gives the opacity.
// .pal: each line has one "Key: values", in upper or lower case. ';' begins a comment, and so does
// '#' at the beginning of a line.
//   Product: BR BV SRV SW ZDR CC PHI ET VIL ...   Tells the moment; other products are accepted.
//   Units:   Without a Scale, KT KTS MPH KMH KFT FT M % are converted to our units.
//   Scale: s, Offset: o   value in the file = s * value in our unit + o
//   Step:    The spacing of ticks; it is the length of the last class in the color bar.
//   Color: value r g b [r g b], Color4: value r g b a [r g b a]   The color from this value up to
//                                                                 the next entry. It blends from
//                                                                 the first color to the second, or
//                                                                 to the color of the next entry.
//   SolidColor: value r g b, SolidColor4: value r g b a   Does not blend and ignores a second
//                                                         color.
//   RF: r g b [a]   Range folded.
//   ND: r g b [a]   Ignored, because cells without a value are drawn by their state.
// Entries may rise or fall; two entries at one value make an edge.
//
// Source    The color table specification of the GRLevelX programs (grlevelx.com, "Color Table File
//           Specification").
// Threads   Pure functions.
// Errors    not_found, io and others for the file; bad_argument, as "FILE:LINE: why", for its
//           content, and for more than most_color_file_bytes or most_stops entries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

inline constexpr std::uint64_t most_color_file_bytes = std::uint64_t{1} << 20U;
// The largest absolute value of a number in a file.
inline constexpr double greatest_color_value = 1e6;

// Parses a .pal file. `name` names the file in messages.
[[nodiscard]] Result<ColorTable> parse_pal(std::string_view text, const std::string& name);
[[nodiscard]] Result<ColorTable> parse_toml_colors(std::string_view text, const std::string& name);
// Reads a .pal or .toml file. The ending, in upper or lower case, tells the format. Errors:
// bad_argument for another ending.
[[nodiscard]] Result<ColorTable> read_color_file(const std::filesystem::path& file);
// Returns a built-in table by its name. If the text ends in .pal or .toml, reads that file instead.
// Errors: bad_argument for an unknown name.
[[nodiscard]] Result<ColorTable> colors_from(const std::string& name_or_file);

// Returns the extinction for a table whose stops are set. A table for a moment gets
// default_extinction(). Any other table gets an extinction that rises from 0.02 to 0.5 per km. In
// both cases, the alpha of the table's colors multiplies the extinction.
[[nodiscard]] std::vector<ExtinctionPoint> extinction_of_colors(const ColorTable& table,
                                                                bool of_moment);

}  // namespace stormcellar::render

// render/colour/colour_file.h -- colour tables of the user's own: TOML and GRLevelX .pal files.
//
// TOML (docs/rendering.md has an example):
//   name, unit, moment = "REF"   all optional; the moment brings its unit and its opacity
//   stepped = true|false         classes, or (the default) colours that blend to the next point's
//   end                          where the colour bar ends; range_folded: that state's colour
//   [[point]]                    2 at least (1 if stepped), value rising
//     value, colour = "#rrggbb", "#rrggbbaa", [r, g, b] or [r, g, b, a]
//     opacity_per_km             of a volume: optical depth; of all points, or of none (then the
//                                moment's, times the colour's alpha)
//
// .pal: one "Key: values" a line, keys in any case, ';' begins a comment (as '#' does at the
// beginning of a line).
//   Product: BR BV SRV SW ZDR CC PHI ET VIL ... tells the moment; others are taken as they are
//   Units:   without a Scale, KT KTS MPH KMH KFT FT M % are converted to ours
//   Scale: s, Offset: o   value in the file = s * value in our unit + o
//   Step:    between ticks: how long the last class is in the colour bar
//   Color: value r g b [r g b]       from the value up to the next one: blends from the first
//   Color4: value r g b a [r g b a]  colour to the second, or to the next entry's
//   SolidColor: value r g b, SolidColor4: value r g b a   does not blend (a second colour is
//                                                         without meaning)
//   RF: r g b [a]  range folded      ND: r g b [a]  read and not used: what holds no value is drawn
//                                                   as what it is
// Entries may rise or fall; two at one value make an edge. Source: the colour table specification
// of the GRLevelX programs (grlevelx.com, "Color Table File Specification").
//
// Errors: not_found, io ... of the file; bad_argument, "FILE:LINE: why", for what is in it, and for
// more than 1 MiB or most_stops entries.
// Thread contract: pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/render/colour_table.h"

namespace stormcellar::render {

// `name` stands for the file in messages.
[[nodiscard]] Result<ColourTable> parse_pal(std::string_view text, const std::string& name);
[[nodiscard]] Result<ColourTable> parse_toml_colours(std::string_view text,
                                                     const std::string& name);
// By the ending, .pal or .toml in any case; bad_argument for another.
[[nodiscard]] Result<ColourTable> read_colour_file(const std::filesystem::path& file);
// The name of a built-in table, or a file. What ends in .pal or .toml is a file.
[[nodiscard]] Result<ColourTable> colours_from(const std::string& name_or_file);

// The moment's extinction (default_extinction) times the alpha of the table's colours, for a table
// whose stops are there. A table of no moment: rises evenly from 0.02 to 0.5 per km.
[[nodiscard]] std::vector<ExtinctionPoint> extinction_of_colours(const ColourTable& table,
                                                                 bool of_moment);

}  // namespace stormcellar::render

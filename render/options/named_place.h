// render/options/named_place.h -- places as people write them: LAT,LON, a town or a radar.
//
// Every option that takes a place takes it from here.
//
// Threads   Any thread, once the options are read.
// Errors    bad_argument, naming the option, with the candidates of a name that several places have
//           and the nearest name of one that none has.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::render {

// The forms of a place, for help.
inline constexpr std::string_view place_for_help =
    "LAT,LON in degrees, a town as in \"Moore, OK\", or a radar as in KTLX";

// Reads "35.3,-97.5", "Moore, OK" or "KTLX". A town without its state is taken if only one town has
// the name, or only one of 100,000 people and more. The name of a radar's place, which no town
// has, is that of the radar.
[[nodiscard]] Result<grid::GeoPoint> parse_place(std::string_view option, const std::string& text);

// Reads two places, with a semicolon between them: "Moore, OK; KINX". Four numbers may have commas
// only: "35,-98.5,35.6,-96.5".
[[nodiscard]] Result<std::vector<grid::GeoPoint>> parse_two_places(std::string_view option,
                                                                   const std::string& text);

}  // namespace stormcellar::render

// grid/frame/named_place.h -- reads places as people write them: LAT,LON, a town, or a radar.
//
// All options and keys that take a place use these functions.
//
// Threads   Any thread may call the functions once the options are read.
// Errors    bad_argument. If several places have the name, the message lists them. If the name is
//           unknown, the message suggests a similar name, if there is one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

// The forms of a place, for help.
inline constexpr std::string_view place_for_help =
    "LAT,LON in degrees, a town as in \"Moore, OK\", or a radar as in KTLX";

// Reads a place such as "35.3,-97.5", "Moore, OK" or "KTLX". The state of a town may be left out if
// the town is the only one of this name, or the only one with 100,000 people or more. If no town
// has the name but the place of a radar does, returns that radar.
[[nodiscard]] Result<GeoPoint> place_named(const std::string& text);

// Does the same for the value of an option. The message of an error names the option.
[[nodiscard]] Result<GeoPoint> parse_place(std::string_view option, const std::string& text);

// Reads two places with a semicolon between them, as in "Moore, OK; KINX". Four numbers may have
// only commas between them: "35,-98.5,35.6,-96.5".
[[nodiscard]] Result<std::vector<GeoPoint>> parse_two_places(std::string_view option,
                                                             const std::string& text);

}  // namespace stormcellar::grid

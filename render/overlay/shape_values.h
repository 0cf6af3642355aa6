// render/overlay/shape_values.h -- reads the kinds of values that all files of shapes have. Used
// only inside this room.
//
// Errors    corrupt, with the value.
// Threads   Pure functions.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

// Returns the place. Longitudes from 180 to 360 degrees become -180 to 0.
[[nodiscard]] Result<grid::GeoPoint> shape_place(double latitude_deg, double longitude_deg);
// Returns the first 80 characters of a text, safe to draw (base/printable.h).
[[nodiscard]] std::string shape_label(std::string_view text);
// Reads #rgb or #rrggbb.
[[nodiscard]] Result<Rgba8> shape_color(std::string_view text);
// Reads a time. The text is ISO 8601 with Z, with an offset such as -05:00 or without a zone (UTC),
// or has the digits YYYYMMDDhhmm.
[[nodiscard]] Result<UtcTime> shape_time(std::string_view text);

}  // namespace stormcellar::render

// render/overlay/shape_values.h -- reads the values that files of shapes share. Used only inside
// this room.
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

// Returns the place. Longitudes up to 360 degrees are turned into those from -180 to 180.
[[nodiscard]] Result<grid::GeoPoint> shape_place(double latitude_deg, double longitude_deg);
// Returns the first 80 characters of a text, safe to draw (base/printable.h).
[[nodiscard]] std::string shape_label(std::string_view text);
// Reads #rgb or #rrggbb.
[[nodiscard]] Result<Rgba8> shape_color(std::string_view text);
// Reads ISO 8601 with Z, with an offset such as -05:00, or without either (UTC), and the digits
// YYYYMMDDhhmm.
[[nodiscard]] Result<UtcTime> shape_time(std::string_view text);

}  // namespace stormcellar::render

// render/overlay/shape_file.h -- reads lines and points that others made, to draw them over a
// picture: GeoJSON (RFC 7946) and placefiles of GRLevelX.
//
// GeoJSON   Lines, rings of polygons, and points of features and of bare geometries. Colors and
//           widths are those of simplestyle ("stroke", "stroke-width", "marker-color"), or else the
//           color in which the National Weather Service draws an "event". A label is "title" or
//           "name". A feature is in force from "polygon_begin", "onset", "issue", "effective" or
//           "begin" until "polygon_end", "ends", "expire", "expires" or "end": the names in
//           warnings of the service and of the Iowa Environmental Mesonet. Without these, a feature
//           is always in force.
// Placefile Line, Polygon, Text, Place and Icon (a point), also in an Object, with Color and
//           TimeRange. Triangles and images cannot be drawn, nor lines in an Object, whose places
//           are pixels; `unknown` counts them.
//
// Units     Degrees on WGS84.
// Errors    Those of read_file(). corrupt, with the place in the file: text that is neither format,
//           places that are not on the earth, colors and times that cannot be read. over_budget:
//           more than 64 MiB, or more than a million points.
// Threads   Pure functions.
// Source    RFC 7946; the Placefile specification of Gibson Ridge Software; simplestyle-spec 1.1.0.
#pragma once

#include <filesystem>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/render/overlays.h"

namespace stormcellar::render {

inline constexpr std::size_t most_shape_points = 1'000'000;

// Reads a file of either format. The text's first letter tells the format: GeoJSON begins with a
// brace. The overlay has no name.
[[nodiscard]] Result<ShapeOverlay> read_shape_file(const std::filesystem::path& file);

[[nodiscard]] Result<ShapeOverlay> shapes_of_geojson(std::string_view text);
[[nodiscard]] Result<ShapeOverlay> shapes_of_placefile(std::string_view text);

}  // namespace stormcellar::render

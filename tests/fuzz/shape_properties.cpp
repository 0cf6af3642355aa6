// Reads files of shapes.
#include <cmath>
#include <string_view>

#include "render/overlay/shape_file.h"
#include "tests/fuzz/properties.h"

namespace stormcellar::fuzz {
namespace {

void check_shapes_read(const Result<render::ShapeOverlay>& read) {
    if (!read) {
        const ErrorCode code = read.error().code;
        require(code == ErrorCode::corrupt || code == ErrorCode::over_budget, "another error: {}",
                read.error().message);
        return;
    }
    std::size_t points = 0;
    for (const render::OverlayShape& shape : read->shapes) {
        points += shape.points.size();
        require(!shape.points.empty(), "a shape has no points");
        require(shape.width >= 0.5F && shape.width <= 20, "a width of {}", shape.width);
        require(shape.label.size() <= 1000, "a label of {} bytes", shape.label.size());
        for (const grid::GeoPoint& place : shape.points)
            require(std::abs(place.latitude_deg) <= 90 && std::abs(place.longitude_deg) <= 180,
                    "a point at {}, {}", place.latitude_deg, place.longitude_deg);
    }
    // The last point of a contour is added to close it.
    require(points <= 2 * render::most_shape_points, "{} points", points);
}

}  // namespace

void check_shapes(std::span<const std::byte> file) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    check_shapes_read(render::shapes_of_geojson(text));
    check_shapes_read(render::shapes_of_placefile(text));
}

}  // namespace stormcellar::fuzz

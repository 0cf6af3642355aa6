// stormcellar/render/scene.h -- what to show: product, camera, colors, labels.
//
// Units     Each member names its unit in its name or its comment; heights are above mean sea
//           level.
// Threads   Plain data and pure functions.
// Errors    See validate() and product_from_name().
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/colour_table.h"
#include "stormcellar/render/integration.h"
#include "stormcellar/render/light.h"

namespace stormcellar::render {

// render/products/flat_field.h describes each product; render/products/section.h the section.
enum class Product { volume, composite, cappi, section, echo_top, vil, lowest_seen, highest_seen };
[[nodiscard]] Result<Product> product_from_name(std::string_view name);  // bad_argument lists names
[[nodiscard]] std::string_view product_name(Product product);
// Returns true for a map of the grid's columns, seen from above: every product except volume and
// section.
[[nodiscard]] bool is_map(Product product);

// The place of a camera: meters east and north of the middle of the grid, and a height above sea
// level.
struct Eye {
    double x_m = 0, y_m = 0, height_m = 0;
};

// Without a place of its own, the camera looks from outside at the middle of the box that holds the
// cells and the ground under them.
struct Camera {
    double azimuth_deg = 180;  // from where it looks: 180 is from the south, north is up; finite
    double tilt_deg = 55;      // from the vertical: 0 straight down, 90 along the ground; 0..90,
                               // with a place of its own to 180, which is straight up
    double zoom = 1;           // 1: the whole grid fits into the image; 0.01..1000
    double field_of_view_deg = 0;  // across the image at zoom 1; 0: orthographic; else 1..150
    std::optional<Eye> eye = std::nullopt;  // needs a field of view
};

// A vertical section along the geodesic between two places.
struct SectionLine {
    grid::GeoPoint from, to;  // latitudes -90..90, longitudes -180..360; 1..5000 km apart
};

struct Scene {
    Product product = Product::volume;
    level2::Moment moment = level2::Moment::ref;        // of the grid; echo_top and vil need REF
    std::optional<ColourTable> colours = std::nullopt;  // none: see colours_of()
    double cappi_height_m = 3000;                       // above sea level; -1..60 km
    std::optional<SectionLine> section = std::nullopt;  // of a section it must be there
    double echo_top_dbz = 18.5;                         // -30..80
    int width = 796, height = 532;                      // pixels; 16..8192
    Camera camera;
    int slices = 256;                  // parallel to the image plane; 8..4096
    double vertical_exaggeration = 5;  // stated in the picture; 0.1..100
    bool curved_earth = false;         // volumes: the ground falls away from the grid's middle
    // How exactly a volume is drawn (render/volume/slicer.h).
    Integration integration = Integration::second_order;
    double pixel_tolerance = 0;          // 0..0.1
    Light light;                         // off unless asked for
    bool haze = false;                   // volumes: air that was not seen veils what is behind it
    double opacity = 1;                  // scales the transfer function's opacity; 0.001..1000
    double range_ring_spacing_m = 50e3;  // 1..1000 km
    bool labels = true;                  // color bar, title, time, rings
};
// Checks a scene. Returns bad_argument, naming the first member that is outside its range. NaN is
// outside every range.
[[nodiscard]] Status validate(const Scene& scene);

// Returns the table of the scene, or else that of the product, or else that of the moment.
[[nodiscard]] const ColourTable& colours_of(const Scene& scene);
// Returns the unit of what the product shows ("dBZ", "km"), or an empty text for a number without a
// unit.
[[nodiscard]] std::string unit_shown(const Scene& scene);

}  // namespace stormcellar::render

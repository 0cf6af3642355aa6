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

#include "stormcellar/base/number_range.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/integration.h"
#include "stormcellar/render/light.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/theme.h"
#include "stormcellar/render/units.h"

namespace stormcellar::render {

// The ranges of the numbers of a scene. validate() checks them, and the options and scene files of
// the command line take them from here. Azimuths may be any finite number.
namespace limits {
inline constexpr NumberRange side_px{16, 8192};        // width and height
inline constexpr NumberRange tilt_deg{0, 90};          // of a camera that looks from outside
inline constexpr NumberRange tilt_of_eye_deg{0, 180};  // of one with a place of its own
inline constexpr NumberRange zoom{0.01, 1000};
inline constexpr NumberRange field_of_view_deg{1, 150};  // or 0
inline constexpr NumberRange eye_m{-1e7, 1e7};           // to the east, and to the north
inline constexpr NumberRange eye_height_m{-1e3, 1e7};
inline constexpr NumberRange latitude_deg{-90, 90};
inline constexpr NumberRange longitude_deg{-180, 360};
inline constexpr NumberRange section_km{1, 5000};
inline constexpr NumberRange cappi_height_m{-1e3, 6e4};
inline constexpr NumberRange echo_top_dbz{-30, 80};
inline constexpr NumberRange elevation_deg{-10, 90};  // or Scene::lowest_sweep
inline constexpr NumberRange sweep_number{0, 9999};   // or Scene::no_number
inline constexpr NumberRange slices{8, 4096};
inline constexpr NumberRange exaggeration{0.1, 100};
inline constexpr NumberRange pixel_tolerance{0, 0.1};
inline constexpr NumberRange sun_elevation_deg{5, 90};
inline constexpr NumberRange opacity{1e-3, 1e3};
inline constexpr NumberRange ring_spacing_m{1e3, 1e6};
}  // namespace limits

// The place of a camera, or of what it looks at: meters east and north of the middle of the grid,
// and a height above sea level.
struct Eye {
    double x_m = 0, y_m = 0, height_m = 0;
};

// Without a place of its own, the camera looks from outside at the middle of the box that holds the
// cells and the ground under them.
struct Camera {
    double azimuth_deg = 180;  // from where it looks: 180 is from the south, north is up
    double tilt_deg = 55;      // from the vertical: 0 straight down, 90 along the ground, and for a
                               // camera with a place of its own 180 straight up
    double zoom = 1;           // 1: the whole grid fits into the image
    double field_of_view_deg = 0;           // across the image at zoom 1; 0: orthographic
    std::optional<Eye> eye = std::nullopt;  // needs a field of view
    // The point in the middle of the picture. A camera with a place of its own turns to it,
    // whatever its azimuth and tilt are; one that looks from outside keeps these two.
    std::optional<Eye> look_at = std::nullopt;
};

// A vertical section along the geodesic between two places.
struct SectionLine {
    grid::GeoPoint from, to;
};

struct Scene {
    Product product = Product::volume;
    level2::Moment moment = level2::Moment::ref;        // of the grid; some products need REF
    std::optional<ColorTable> colors = std::nullopt;    // none: see colors_of()
    double cappi_height_m = 3000;                       // above sea level
    std::optional<SectionLine> section = std::nullopt;  // of a section it must be there
    double echo_top_dbz = 18.5;
    // For a ppi: the elevation and number by which the sweep is looked up in a volume. The picture
    // shows the sweep of its view, whose angle scene_shown() puts here.
    static constexpr double lowest_sweep = -90;
    static constexpr int no_number = -1;
    double elevation_deg = lowest_sweep;
    int sweep_number = no_number;
    int width = 796, height = 532;  // pixels
    Camera camera;
    int slices = 256;                  // parallel to the image plane
    double vertical_exaggeration = 5;  // stated in the picture
    bool curved_earth = false;         // volumes: the ground falls away from the grid's middle
    // The accuracy of a drawn volume (render/volume/slicer.h).
    Integration integration = Integration::second_order;
    double pixel_tolerance = 0;  // 0..0.1
    Light light;                 // off unless asked for
    bool haze = false;           // volumes: air that was not seen veils what is behind it
    bool smooth = false;         // maps: values go smoothly from cell to cell
    double opacity = 1;          // scales the transfer function's opacity; 0.001..1000
    // 1..1000 km, or 50 km and more by the size of the grid.
    static constexpr double usual_rings = 0;
    double range_ring_spacing_m = usual_rings;
    bool labels = true;  // color bar, title, time, map
    Theme theme = Theme::dark;
    Units units;  // of what is written
};
// Checks a scene. Returns bad_argument, naming the first member that is outside its range. NaN is
// outside every range.
[[nodiscard]] Status validate(const Scene& scene);

}  // namespace stormcellar::render

// stormcellar/render/scene.h -- the description of a picture: product, camera, colors, labels.
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
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::render {

// The ranges of the numbers of a scene. validate() checks them, and the options and scene files of
// the command line take them from here. Azimuths may be any finite number.
namespace limits {
inline constexpr NumberRange side_px{16, 8192};        // width and height
inline constexpr NumberRange tilt_deg{0, 90};          // of a camera without an `eye`
inline constexpr NumberRange tilt_of_eye_deg{0, 180};  // of a camera with an `eye`
inline constexpr NumberRange zoom{0.01, 1000};
inline constexpr NumberRange field_of_view_deg{1, 150};  // or 0
inline constexpr NumberRange eye_m{-1e7, 1e7};           // to the east, and to the north
inline constexpr NumberRange eye_height_m{-1e3, 1e7};
inline constexpr NumberRange latitude_deg{-90, 90};
inline constexpr NumberRange longitude_deg{-180, 360};
inline constexpr NumberRange section_km{1, 5000};
inline constexpr NumberRange cappi_height_m{-1e3, 6e4};
inline constexpr NumberRange echo_top_dbz{-30, 80};
inline constexpr NumberRange zero_c_m{-1000, 7000};
inline constexpr NumberRange minus_20_c_m{0, 15000};
inline constexpr NumberRange elevation_deg{-10, 90};  // or Scene::lowest_sweep
inline constexpr NumberRange sweep_number{0, 9999};   // or Scene::no_number
inline constexpr NumberRange slices{8, 4096};
inline constexpr NumberRange exaggeration{0.1, 100};
inline constexpr NumberRange pixel_tolerance{0, 0.1};
inline constexpr NumberRange sun_elevation_deg{5, 90};
inline constexpr NumberRange opacity{1e-3, 1e3};
inline constexpr NumberRange ring_spacing_m{1e3, 1e6};
}  // namespace limits

// The place of a camera or of the point that it looks at: meters east and north of the middle of
// the grid, and the height above sea level.
struct Eye {
    double x_m = 0, y_m = 0, height_m = 0;
};

// A camera without an `eye` is outside the grid and looks at the middle of the box that holds the
// cells and the ground under them.
struct Camera {
    double azimuth_deg = 180;      // direction to the camera; from 180, the south, north is up
    double tilt_deg = 55;          // from the vertical: 0 straight down, 90 along the ground, 180
                                   // straight up (only with an `eye`)
    double zoom = 1;               // 1: the whole grid fits into the image
    double field_of_view_deg = 0;  // across the image at zoom 1; 0: orthographic
    std::optional<Eye> eye = std::nullopt;  // needs a field of view
    // The point in the middle of the picture. A camera with an `eye` turns to this point and
    // ignores its azimuth and tilt; a camera without an `eye` keeps both.
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
    std::optional<SectionLine> section = std::nullopt;  // required for a section
    double echo_top_dbz = 18.5;
    retrieve::FreezingLevels freezing_levels;  // for hail
    // For a ppi: the elevation and the number that select the sweep of a volume. The picture shows
    // the sweep of its view, and scene_shown() sets elevation_deg to the angle of that sweep.
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
    Light light;                 // off by default
    bool haze = false;           // volumes: air that was not seen is drawn as a veil
    bool smooth = false;         // maps: values go smoothly from cell to cell
    bool glyphs = false;         // a ppi of a velocity: glyphs of the wind along the beam
    double opacity = 1;          // scales the transfer function's opacity; 0.001..1000
    // Spacing of range rings: 1 to 1000 km, or usual_rings, which lets the size of the grid choose
    // the spacing.
    static constexpr double usual_rings = 0;
    double range_ring_spacing_m = usual_rings;
    bool labels = true;  // color bar, title, time, map
    Theme theme = Theme::dark;
    Units units;  // units of written numbers
};
// Returns true for a moment that is a velocity along the beam: VEL, VELD, SRV.
[[nodiscard]] bool has_beam_glyphs(level2::Moment moment);
// Checks a scene. Returns bad_argument and names the first member that is outside its range. NaN is
// outside every range.
[[nodiscard]] Status validate(const Scene& scene);

}  // namespace stormcellar::render

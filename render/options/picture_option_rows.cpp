#include <algorithm>
#include <array>

#include "base/name_list.h"
#include "render/options/picture_option_values.h"
#include "render/options/picture_options.h"
#include "render/options/scene_options.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

using To = PictureSettings;

constexpr double per_km = option_units_per_km;
// The range of directions in a scene file. A direction beyond ten turns must be a mistake. The
// command line accepts every direction.
constexpr NumberRange turns_deg{-3600, 3600};

constexpr ProductUse by_volume{.only = Product::volume};
constexpr ProductUse by_cappi{.only = Product::cappi};
constexpr ProductUse by_section{.only = Product::section};
constexpr ProductUse by_ppi{.only = Product::ppi};
constexpr ProductUse by_threshold{.with_threshold = true};
constexpr ProductUse by_maps{.maps = true};
constexpr ProductUse by_hail{.hail = true};
constexpr ProductUse by_all_but_section{.all_but = Product::section};

constexpr std::array section_places{
    NumberPlace{"latitude", limits::latitude_deg}, NumberPlace{"longitude", limits::longitude_deg},
    NumberPlace{"latitude", limits::latitude_deg}, NumberPlace{"longitude", limits::longitude_deg}};
constexpr std::array camera_places{NumberPlace{"east", limits::eye_m.in(per_km)},
                                   NumberPlace{"north", limits::eye_m.in(per_km)},
                                   NumberPlace{"up", limits::eye_height_m.in(per_km)}};
constexpr std::array freezing_places{NumberPlace{"0 C", limits::zero_c_m},
                                     NumberPlace{"-20 C", limits::minus_20_c_m}};
constexpr std::array sun_places{NumberPlace{"azimuth", turns_deg},
                                NumberPlace{"elevation", limits::sun_elevation_deg}};

constexpr std::array option_rows{
    PictureOption{.option = "--product",
                  .section = "picture",
                  .key = "product",
                  .value = TextValue{.field = [](To to) { return &to.options.product; },
                                     .check = check_product,
                                     .known = products_for_help},
                  .help = "What to draw: {}"},
    PictureOption{.option = "--moment",
                  .section = "picture",
                  .key = "moment",
                  .value = TextValue{.field = [](To to) { return &to.options.moment; },
                                     .check = check_moment,
                                     .known = known_moments},
                  .help = "The moment to draw: {}"},
    PictureOption{.option = "--dealias",
                  .section = "picture",
                  .key = "dealias",
                  .value = TextValue{.field = [](To to) { return &to.options.dealias; },
                                     .check = check_dealiasing,
                                     .known = known_dealiasings},
                  .help = "How to dealias the velocity (VELD instead of VEL): {}"},
    PictureOption{.option = "--storm-motion",
                  .section = "picture",
                  .key = "storm_motion",
                  .value = TextValue{.field = [](To to) { return &to.options.storm_motion; },
                                     .check = check_motion,
                                     .known = known_motions},
                  .help = "The motion to which the storm-relative velocity, SRV, refers: {}"},
    PictureOption{.option = "--quality",
                  .section = "picture",
                  .key = "quality",
                  .value = NumberValue{.field = [](To to) { return &to.options.quality; },
                                       .range = {0, 1},
                                       .checked = Checked::by_the_parser},
                  .help = "Leave out echo whose probability of weather is less than this, {} to "
                          "{}. 0.5 leaves out most birds, insects and ground"},
    PictureOption{.option = "--colors",
                  .old_option = "--colours",
                  .section = "picture",
                  .key = "colors",
                  .old_key = "colours",
                  .value = TextValue{.field = [](To to) { return &to.options.colors; },
                                     .check = check_colors,
                                     .beside = colors_beside,
                                     .is_file = is_color_file},
                  .help =
                      "smooth for colors without classes (the default), nws for the classes of the "
                      "Weather Service, the name of a color table, or a .pal or .toml file"},
    PictureOption{.option = "--smooth",
                  .section = "picture",
                  .key = "smooth",
                  .value = TextValue{.field = [](To to) { return &to.options.smooth; },
                                     .check = check_smoothing,
                                     .known = known_smoothings},
                  .used_by = by_maps,
                  .help = "How the values of a map go from cell to cell, for the eye alone: {}, "
                          "which shows the cells as they are. Default: cubic"},
    PictureOption{.option = "--glyphs",
                  .section = "picture",
                  .key = "glyphs",
                  .value = FlagValue{.field = [](To to) { return &to.scene.glyphs; }},
                  .used_by = by_ppi,
                  .help = "Draw glyphs of the wind over a velocity: a line for the part along the "
                          "beam, a disc for the part that one radar cannot measure"},
    PictureOption{.option = "--overlay",
                  .section = "picture",
                  .key = "overlay",
                  .value = TextValue{.field = [](To to) { return &to.options.overlay; },
                                     .check = check_overlay,
                                     .beside = overlay_beside,
                                     .known = known_overlays},
                  .used_by = by_all_but_section,
                  .help =
                      "Draw over the picture: {} for storm cells with their largest reflectivity, "
                      "their tracks, and forecasts with errors; or a file of GeoJSON, such as "
                      "warnings, or a placefile, whose shapes are drawn while they are in force; "
                      "or several of these, separated by commas. Tracks need several volumes: "
                      "files of one radar, or a domain. With --freezing-levels, labels of cells "
                      "also have MESH in mm"},
    PictureOption{.option = "--height-km",
                  .section = "picture",
                  .key = "height_km",
                  .value = NumberValue{.field = [](To to) { return &to.scene.cappi_height_m; },
                                       .range = limits::cappi_height_m.in(per_km),
                                       .unit = per_km},
                  .used_by = by_cappi,
                  .help = "Height of a CAPPI above sea level in km, {} to {}"},
    PictureOption{.option = "--elevation",
                  .section = "picture",
                  .key = "elevation_deg",
                  .value = NumberValue{.field = [](To to) { return &to.scene.elevation_deg; },
                                       .range = limits::elevation_deg},
                  .used_by = by_ppi,
                  .help = "Draw the newest sweep nearest to this angle in degrees, {} to {}. "
                          "Default: the lowest sweep"},
    PictureOption{.option = "--sweep",
                  .section = "picture",
                  .key = "sweep",
                  .value = WholeValue{.field = [](To to) { return &to.scene.sweep_number; },
                                      .range = limits::sweep_number},
                  .used_by = by_ppi,
                  .help = "Draw the sweep of this number, as stormcellar info lists them from 0"},
    PictureOption{.option = "--section",
                  .section = "picture",
                  .key = "section",
                  .value = NumbersValue{section_places, set_section, read_section},
                  .used_by = by_section,
                  .help = "The two ends of a vertical section: LAT,LON,LAT,LON in degrees, or two "
                          "places as in \"Moore, OK; KINX\""},
    PictureOption{.option = "--echo-top-dbz",
                  .section = "picture",
                  .key = "echo_top_dbz",
                  .value = NumberValue{.field = [](To to) { return &to.scene.echo_top_dbz; },
                                       .range = limits::echo_top_dbz},
                  .used_by = by_threshold,
                  .help = "Threshold in dBZ of echo tops, of the tops of VIL density and of the "
                          "maximum whose height is shown, {} to {}"},
    PictureOption{.option = "--freezing-levels",
                  .section = "picture",
                  .key = "freezing_levels_m",
                  .value = NumbersValue{freezing_places, set_freezing_levels},
                  .used_by = by_hail,
                  .used_by_cells = true,
                  .used_by_moment = level2::Moment::hca,
                  .help = "Heights above sea level in meters at which the air has 0 and -20 "
                          "degrees Celsius, for hail, and for HCA of volumes that show no melting "
                          "layer. Default: 4200,7300, an assumption for warm days on the Great "
                          "Plains"},
    PictureOption{.option = "--theme",
                  .section = "picture",
                  .key = "theme",
                  .value = TextValue{.field = [](To to) { return &to.options.theme; },
                                     .check = check_theme,
                                     .known = themes_for_help},
                  .help = "The page on which the picture is drawn: {}"},
    PictureOption{.option = "--width",
                  .section = "picture",
                  .key = "width",
                  .value = WholeValue{.field = [](To to) { return &to.scene.width; },
                                      .range = limits::side_px},
                  .help = "Width of the picture in pixels, {} to {}"},
    PictureOption{.option = "--height",
                  .section = "picture",
                  .key = "height",
                  .value = WholeValue{.field = [](To to) { return &to.scene.height; },
                                      .range = limits::side_px},
                  .help = "Height of the picture in pixels, {} to {}"},
    PictureOption{.option = "--azimuth",
                  .section = "camera",
                  .key = "azimuth_deg",
                  .value = NumberValue{.field = [](To to) { return &to.scene.camera.azimuth_deg; },
                                       .range = turns_deg},
                  .used_by = by_volume,
                  .help = "Direction in degrees from which the camera looks; 180 is from the "
                          "south, with north up"},
    PictureOption{.option = "--tilt",
                  .section = "camera",
                  .key = "tilt_deg",
                  .value = NumberValue{.field = [](To to) { return &to.scene.camera.tilt_deg; },
                                       .range = limits::tilt_of_eye_deg},
                  .used_by = by_volume,
                  .help = "Angle between the view and the vertical in degrees: 0 looks straight "
                          "down, 90 along the ground. With --camera-km, it may be up to {1}"},
    PictureOption{.option = "--zoom",
                  .section = "camera",
                  .key = "zoom",
                  .value = NumberValue{.field = [](To to) { return &to.scene.camera.zoom; },
                                       .range = limits::zoom},
                  .used_by = by_all_but_section,
                  .help = "Magnification, {} to {}; 1 shows the whole grid"},
    PictureOption{
        .option = "--field-of-view",
        .section = "camera",
        .key = "field_of_view_deg",
        .value = NumberValue{.field = [](To to) { return &to.scene.camera.field_of_view_deg; },
                             .range = limits::field_of_view_deg,
                             .or_zero = true},
        .used_by = by_volume,
        .help = "Angle across the picture in degrees, {} to {}, for a perspective view; 0 gives a "
                "view with parallel rays"},
    PictureOption{.option = "--camera-km",
                  .section = "camera",
                  .key = "at_km",
                  .value = NumbersValue{camera_places, set_camera},
                  .used_by = by_volume,
                  .help = "Position of the camera in km from the grid's middle and above sea "
                          "level: EAST,NORTH,UP"},
    PictureOption{.option = "--look-at-km",
                  .section = "camera",
                  .key = "look_at_km",
                  .value = NumbersValue{camera_places, set_look_at},
                  .used_by = by_volume,
                  .help = "Point in the middle of the picture, in km from the grid's middle and "
                          "above sea level: EAST,NORTH,UP. With --camera-km, it takes the place of "
                          "--azimuth and --tilt"},
    PictureOption{
        .option = "--light",
        .section = "light",
        .key = "kinds",
        .value = NamesValue{set_light_kinds, light_kinds},
        .used_by = by_volume,
        .help = "Kinds of light, separated by commas: gradient, shadow, scattering, or none for "
                "exact colors. Light changes neither the hue of echo nor its mean lightness"},
    PictureOption{.option = "--sun",
                  .section = "light",
                  .key = "sun_deg",
                  .value = NumbersValue{sun_places, set_sun},
                  .used_by = by_volume,
                  .help = "Direction of the light: AZIMUTH,ELEVATION in degrees"},
    PictureOption{.option = "--haze",
                  .section = "volume",
                  .key = "haze",
                  .value = FlagValue{.field = [](To to) { return &to.scene.haze; }},
                  .used_by = by_volume,
                  .help = "Show the air that no beam saw as haze behind the echo of a volume"},
    PictureOption{.option = "--curved-earth",
                  .section = "volume",
                  .key = "curved_earth",
                  .value = FlagValue{.field = [](To to) { return &to.scene.curved_earth; }},
                  .used_by = by_volume,
                  .help = "Let the ground fall away from the grid's middle, as the earth does"},
    PictureOption{.option = "--slices",
                  .section = "volume",
                  .key = "slices",
                  .value = WholeValue{.field = [](To to) { return &to.scene.slices; },
                                      .range = limits::slices},
                  .used_by = by_volume,
                  .help = "Number of slices through the volume, {} to {}"},
    PictureOption{
        .option = "--exaggeration",
        .section = "volume",
        .key = "exaggeration",
        .value = NumberValue{.field = [](To to) { return &to.scene.vertical_exaggeration; },
                             .range = limits::exaggeration},
        .used_by = by_volume,
        .help = "Factor that stretches heights, {} to {}"},
    PictureOption{.option = "--opacity",
                  .section = "volume",
                  .key = "opacity",
                  .value = NumberValue{.field = [](To to) { return &to.scene.opacity; },
                                       .range = limits::opacity},
                  .used_by = by_volume,
                  .help = "Factor on the opacity of echo, {} to {}"},
    PictureOption{
        .option = "--ring-spacing-km",
        .section = "labels",
        .key = "ring_spacing_km",
        .value = NumberValue{.field = [](To to) { return &to.scene.range_ring_spacing_m; },
                             .range = limits::ring_spacing_m.in(per_km),
                             .unit = per_km},
        .used_by = by_all_but_section,
        .help = "Distance from one range ring to the next in km, {} to {}. Default: 50, or more "
                "where the map is large"},
    PictureOption{
        .option = "--units",
        .section = "labels",
        .key = "units",
        .value = NamesValue{set_units, units_set},
        .help = "Units in which the picture writes speeds, distances and heights, separated by "
                "commas, as in knots,miles,kft: m/s, knots, mph or km/h; km, miles or "
                "nautical-miles; km, kft or feet"},
    PictureOption{.option = "--time-zone",
                  .section = "labels",
                  .key = "time_zone",
                  .value = TextValue{.field = [](To to) { return &to.options.time_zone; },
                                     .check = check_time_zone},
                  .help = "Time zone of the local time, such as America/Chicago. Default: the zone "
                          "of the machine"},
    PictureOption{.option = "--no-labels",
                  .section = "labels",
                  .key = "show",
                  .value = FlagValue{.field = [](To to) { return &to.options.no_labels; },
                                     .is_reversed = true},
                  .help = "Draw the picture without labels"},
    PictureOption{.option = "--threads",
                  .value = WholeValue{.field = [](To to) { return &to.options.threads; },
                                      .range = thread_range},
                  .help = "Number of threads, at most {1}; 0 uses all processors"},
    PictureOption{.option = "--last",
                  .section = "loop",
                  .key = "last",
                  .value = WholeValue{.field = [](To to) { return &to.loop->last; },
                                      .range = {1, 1'000'000},
                                      .checked = Checked::by_the_parser},
                  .help = "Use only the newest N of these grids"},
    PictureOption{
        .option = "--fps",
        .section = "loop",
        .key = "fps",
        .value = NumberValue{.field = [](To to) { return &to.loop->animation.frames_per_second; },
                             .range = limits::frames_per_second},
        .help = "Frames per second, {} to {}"},
    PictureOption{
        .option = "--dwell",
        .section = "loop",
        .key = "dwell_s",
        .value = NumberValue{.field = [](To to) { return &to.loop->animation.last_frame_dwell_s; },
                             .range = limits::last_frame_dwell_s},
        .help = "Seconds by which the last frame stays longer than the others, {} to {}"},
    PictureOption{.option = "--frames",
                  .section = "loop",
                  .key = "frames",
                  .value = WholeValue{.field = [](To to) { return &to.loop->frames; },
                                      .range = {1, 100'000},
                                      .checked = Checked::by_the_parser},
                  .help = "Number of frames, spread evenly over the grids, for a camera that moves "
                          "faster than time. Default: one for each grid"},
    PictureOption{
        .option = "--orbit",
        .section = "loop",
        .key = "orbit_deg",
        .value = NumberValue{.field = [](To to) { return &to.loop->orbit_deg; },
                             .range = turns_deg,
                             .checked = Checked::by_the_parser},
        .used_by = by_volume,
        .help =
            "Degrees that the camera moves around the grid during the loop; 360 is one full turn"},
    PictureOption{.option = "--all-elevations",
                  .section = "loop",
                  .key = "all_elevations",
                  .value = FlagValue{.field = [](To to) { return &to.loop->all_elevations; }},
                  .used_by = by_ppi,
                  .help = "Show each elevation of each volume, from the lowest up"},
    PictureOption{.option = "--repeats",
                  .section = "loop",
                  .key = "repeats",
                  .value = FlagValue{.field = [](To to) { return &to.loop->repeats; }},
                  .used_by = by_ppi,
                  .help = "Show each sweep that a volume has at the elevation, in order of time, "
                          "where the radar repeats it (SAILS, MRLE). Default: the newest"},
    PictureOption{.option = "--ping-pong",
                  .section = "loop",
                  .key = "ping_pong",
                  .value = FlagValue{.field = [](To to) { return &to.loop->ping_pong; }},
                  .help = "Play the loop forward and backward: after the last frame, the others "
                          "follow in reverse, down to the second"},
};

// Returns the row that has this key. `key` is always a constant of this file, so there is such a
// row.
const PictureOption& row_of(std::string_view key) {
    return *std::ranges::find(option_rows, key, &PictureOption::key);
}

constexpr std::string_view as_fits = "as fits the echo";

struct KeyOfView {
    ViewPart part;
    std::string_view key;
    std::string_view usual = as_fits;
};
constexpr std::array keys_of_the_view = {KeyOfView{ViewPart::azimuth, "azimuth_deg"},
                                         KeyOfView{ViewPart::tilt, "tilt_deg"},
                                         KeyOfView{ViewPart::zoom, "zoom"},
                                         KeyOfView{ViewPart::field_of_view, "field_of_view_deg"},
                                         KeyOfView{ViewPart::place, "at_km"},
                                         KeyOfView{ViewPart::light, "kinds", "gradient,shadow"},
                                         KeyOfView{ViewPart::sun, "sun_deg"},
                                         KeyOfView{ViewPart::exaggeration, "exaggeration"},
                                         KeyOfView{ViewPart::opacity, "opacity"}};
static_assert(is_in_order(keys_of_the_view, &KeyOfView::part));

}  // namespace

std::span<const PictureOption> picture_options() {
    return option_rows;
}

const PictureOption& slices_option() {
    return row_of("slices");
}

const PictureOption& section_option() {
    return row_of("section");
}

const PictureOption& moment_option() {
    return row_of("moment");
}
const PictureOption& dealias_option() {
    return row_of("dealias");
}
const PictureOption& quality_option() {
    return row_of("quality");
}
const PictureOption& storm_motion_option() {
    return row_of("storm_motion");
}

const PictureOption& overlay_option() {
    return row_of("overlay");
}
const PictureOption& freezing_levels_option() {
    return row_of("freezing_levels_m");
}

const PictureOption& colors_option() {
    return row_of("colors");
}

const PictureOption& width_option() {
    return row_of("width");
}

const PictureOption& height_option() {
    return row_of("height");
}

const PictureOption& option_of(ViewPart part) {
    return row_of(keys_of_the_view[static_cast<std::size_t>(part)].key);
}

std::string_view default_of_the_view(const PictureOption& option) {
    const auto* const found = std::ranges::find(keys_of_the_view, option.key, &KeyOfView::key);
    return found != keys_of_the_view.end() ? found->usual : std::string_view{};
}

bool moves_camera(const PictureOption& option) {
    return option.key == "orbit_deg" || option.key == "at_km" || option.key == "look_at_km";
}

}  // namespace stormcellar::render

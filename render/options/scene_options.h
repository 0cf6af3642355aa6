// render/options/scene_options.h -- the options of a picture, and the scene that is made from them.
//
// The command line, scene files and the addresses of the data server set these options, through the
// table of picture_options.h. In all three cases, scene_of() then makes the scene. So the same
// options give the same picture.
//
// Threads   Plain data and pure functions.
// Errors    See each function.
#pragma once

#include <optional>
#include <string>

#include "render/options/picture_options.h"
#include "stormcellar/base/number_range.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/render/animation.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::render {

inline constexpr NumberRange thread_range{0, 1024};
// The word of an overlay that marks storm cells (render/map/cell_marks.h). The other words are
// files of shapes (render/overlay/shape_file.h).
inline constexpr std::string_view overlay_cells = "cells";

// The form in which messages write the name of an option.
enum class Spelling { option, parameter };  // "--tilt", "tilt"

// The settings of a picture, from its options and from a scene file (picture_options.h).
struct SceneOptions {
    std::string product = "volume";
    std::string moment{level2::moment_name(level2::Moment::ref)};
    std::string dealias{retrieve::dealiasing_name(retrieve::Dealiasing::off)};
    std::string storm_motion{retrieve::automatic_motion};  // of SRV
    double quality = 0;  // the least probability of weather of echo; 0: all echo
    std::string theme{theme_name(Theme::dark)};
    std::string panels;     // from a scene file: "REF,VEL", several in a picture; empty: one moment
    std::string colors;     // empty: the colors of the product or the moment
    std::string smooth;     // cubic or none; empty: cubic, or none for a scene file
    std::string overlay;    // words separated by commas: overlay_cells and files; empty: none
    std::string time_zone;  // IANA; empty: the zone of the machine
    bool no_labels = false;
    int threads = 0;  // 0: as many as the machine has
    Scene scene;      // incomplete: options set it directly; use scene_of()
    // The options that were typed, the options in the scene file, and the product in that file,
    // which is empty without a file.
    ChosenOptions typed;
    ChosenOptions in_file;
    std::string file_product;
    std::optional<Error> problem;  // the first invalid value that was typed
    Spelling spelling = Spelling::option;
};

// The settings of the rows of [loop].
struct LoopChoices {
    int last = 0;    // use only this many of the newest grids; 0: all
    int frames = 0;  // number of frames; 0: one for each grid, or enough for the camera's path
    double orbit_deg = 0;  // angle by which the camera moves around the grid during the loop
    bool ping_pong = false;
    bool all_elevations = false;  // for a ppi: a frame for each elevation of each volume
    bool repeats = false;         // for a ppi: a frame for each sweep of the elevation
    AnimationOptions animation;
};

// Returns the requested scene. It is valid. Errors: bad_argument; the message names the invalid
// option.
[[nodiscard]] Result<Scene> scene_of(const SceneOptions& options);

// Returns true if the command line or a scene file gives freezing levels.
[[nodiscard]] bool chooses_levels(const SceneOptions& options);
// Returns the freezing levels for MESH of storm cells: those that are given, or those of a product
// of hail; none if nobody chose levels.
[[nodiscard]] std::optional<retrieve::FreezingLevels> chosen_freezing_levels(
    const SceneOptions& options, const Scene& scene);

// Returns true if the overlay marks storm cells.
[[nodiscard]] bool marks_cells(const SceneOptions& options);
// Returns the names of the overlay's files: "a.geojson, b.txt".
[[nodiscard]] std::string shape_names(const SceneOptions& options);
// Reads the files of the overlay; none if it has no files. Errors: those of read_shape_file().
[[nodiscard]] Result<std::optional<ShapeOverlay>> read_shapes(const SceneOptions& options);

// Returns the name of the moment. If none is given, and the product is made of one moment only,
// returns that moment.
[[nodiscard]] std::string moment_asked(const SceneOptions& options);

// Refuses a quality, freezing levels of HCA, and a rung of dealiasing and a storm motion other than
// `auto`, for a picture of kept grids, whose moments are derived already. A ppi is made from raw
// files, so it can have any of them.
// Errors: bad_argument, naming the option.
[[nodiscard]] Status check_stored_derivation(const SceneOptions& options, Product product);

// Refuses a product over time for a picture of one kept grid. Errors: bad_argument.
[[nodiscard]] Status check_single_grid(Product product);

// Returns the note of a grid that has the largest values since a time (FrameFacts::since).
[[nodiscard]] std::string track_note(UtcTime since);

// Returns the options for deriving the moments of a picture that is made from raw files. `options`
// must be those of a valid scene.
[[nodiscard]] retrieve::DerivedOptions derived_options_of(const SceneOptions& options);

[[nodiscard]] int thread_count(const SceneOptions& options);

// Returns the facts of a grid for its labels. The local time is in the zone `time_zone` (IANA), or,
// if that is empty, in the zone of the machine. The local time is left out if the zone is UTC or is
// not known. The facts have the age of the newest radial at `now` only if the grid is younger than
// an hour; for an archive, the age would say nothing about the radar.
[[nodiscard]] FrameFacts frame_facts_of(const std::string& domain,
                                        const cache::GridDescription& description,
                                        const std::string& time_zone, UtcTime now = now_utc());

}  // namespace stormcellar::render

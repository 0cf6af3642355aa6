// render/options/picture_options.h -- the table of the options of a picture.
//
// Each row is one option. It has the option's name on the command line, its key in a scene file,
// the values that it takes, the products that use it, its help, and the setting that it sets. The
// command line, the reader of scene files and the addresses of the data server take their options
// from this table. scene_options.h checks with the table which products use an option. --help, the
// manual pages and the completions of shells are made from the command line. The rows are in
// picture_option_rows.cpp.
//
// Threads   The table is constant.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "stormcellar/base/number_range.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct LoopChoices;
struct SceneOptions;

// The objects that options set.
struct PictureSettings {
    SceneOptions& options;
    Scene& scene;       // the scene of the options
    LoopChoices* loop;  // null if only options of the scene are set
};

// Says who refuses a number of the option that is out of range: the parser, or the check of the
// scene. The reader of scene files always refuses such a number, and names its line.
enum class Checked { with_the_scene, by_the_parser };

// A flag on the command line. In a scene file it is true or false.
struct FlagValue {
    bool* (*field)(PictureSettings) = nullptr;
    bool is_reversed = false;  // the key of the scene file means the opposite of the flag
};
struct WholeValue {
    int* (*field)(PictureSettings) = nullptr;
    NumberRange range{};
    Checked checked = Checked::with_the_scene;
};
struct NumberValue {
    double* (*field)(PictureSettings) = nullptr;
    NumberRange range{};  // in the unit of the option
    double unit = 1;      // fields per unit of the option: 1000 for km and m
    bool or_zero = false;
    Checked checked = Checked::with_the_scene;
};
// One of several numbers. Together they are written "35,-98" on the command line, and as an array
// in a scene file.
struct NumberPlace {
    std::string_view name;
    NumberRange range;
};
struct NumbersValue {
    std::span<const NumberPlace> places{};
    void (*set)(PictureSettings, std::span<const double>) = nullptr;
    // Reads the numbers on the command line. Null: commas separate them.
    Result<std::vector<double>> (*read)(const std::string& option,
                                        const std::string& text) = nullptr;
};
struct TextValue {
    std::string* (*field)(PictureSettings) = nullptr;
    Status (*check)(const std::string&) = nullptr;  // its message gives the reason for a refusal
    // Resolves a text of a scene file in `directory`. Null: the text is used as it is.
    std::string (*beside)(const std::filesystem::path& directory,
                          const std::string& text) = nullptr;
    std::string (*known)() = nullptr;  // possible texts, for {} in the help; null: every text is
    bool (*is_file)(const std::string&) = nullptr;  // true if the text is a file; null: never
};
// Several names. They are written "gradient,shadow" on the command line, and as an array of texts
// in a scene file. An empty array means "none".
struct NamesValue {
    Status (*set)(PictureSettings, const std::string& names) = nullptr;
    std::string (*get)(PictureSettings) = nullptr;
};
using PictureValue =
    std::variant<FlagValue, WholeValue, NumberValue, NumbersValue, TextValue, NamesValue>;

// The products that use an option: only one product; all but one; products with a threshold; maps;
// hail. If none of these is set, all products use it.
struct ProductUse {
    std::optional<Product> only{};
    std::optional<Product> all_but{};
    bool with_threshold = false;
    bool maps = false;
    bool hail = false;  // products of hail

    [[nodiscard]] bool includes(Product product) const {
        return (!only || product == *only) && (!all_but || product != *all_but) &&
               (!with_threshold || facts_of(product).threshold_dbz != nullptr) &&
               (!maps || is_map(product)) && (!hail || facts_of(product).hail != nullptr);
    }
    // Returns these products as a text, such as "cappi" or "any product but section".
    [[nodiscard]] std::string text() const;
};

struct PictureOption {
    std::string_view option{};      // "--tilt"
    std::string_view old_option{};  // an older spelling, accepted but not shown
    std::string_view section{};     // of a scene file; empty: no scene file has the option
    std::string_view key{};
    std::string_view old_key{};
    PictureValue value{};
    ProductUse used_by{};
    bool used_by_cells = false;  // every product uses the option if storm cells are marked
    std::optional<level2::Moment> used_by_moment{};  // every product of it uses the option
    std::string_view help{};  // in it, {} or {0} and {1} are replaced by the ends of the range

    // Returns true for an option of [loop], which sets `loop`. All other options set the scene.
    [[nodiscard]] bool is_of_loop() const { return section == "loop"; }
    [[nodiscard]] bool is_used_by(Product product) const { return used_by.includes(product); }
};

// Returns the options in the order of --help.
[[nodiscard]] std::span<const PictureOption> picture_options();

// Options that code outside the table asks for by function.
[[nodiscard]] const PictureOption& slices_option();
[[nodiscard]] const PictureOption& section_option();
[[nodiscard]] const PictureOption& moment_option();
[[nodiscard]] const PictureOption& dealias_option();
[[nodiscard]] const PictureOption& quality_option();
[[nodiscard]] const PictureOption& storm_motion_option();
[[nodiscard]] const PictureOption& overlay_option();
[[nodiscard]] const PictureOption& freezing_levels_option();
[[nodiscard]] const PictureOption& colors_option();
[[nodiscard]] const PictureOption& width_option();
[[nodiscard]] const PictureOption& height_option();

// The parts of a volume's view that are fitted to the echo, unless an option sets them
// (render/options/fitted_view.h).
enum class ViewPart {
    azimuth,
    tilt,
    zoom,
    field_of_view,
    place,
    light,
    sun,
    exaggeration,
    opacity
};
[[nodiscard]] const PictureOption& option_of(ViewPart part);
// Returns the text that help shows as the default of an option with a ViewPart. Returns an empty
// text for other options.
[[nodiscard]] std::string_view default_of_the_view(const PictureOption& option);
// Returns true for an option that places or moves the camera of a loop. Such an option replaces the
// camera keys of a scene file.
[[nodiscard]] bool moves_camera(const PictureOption& option);

// Returns the option's name as a parameter of an address, such as "tilt" for "--tilt".
[[nodiscard]] std::string_view parameter_of(const PictureOption& option);
// Returns the key as messages write it, such as "[volume] slices".
[[nodiscard]] std::string key_of(const PictureOption& option);
[[nodiscard]] std::string help_of(const PictureOption& option);

using ChosenOptions = std::vector<const PictureOption*>;
[[nodiscard]] bool contains(const ChosenOptions& chosen, const PictureOption& option);

}  // namespace stormcellar::render

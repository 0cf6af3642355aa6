// render/options/picture_option_values.h -- checks and sets the values of picture options that need
// more than a field. The table (picture_option_rows.cpp) names these functions.
//
// Threads   Pure, except that they change the given settings.
// Errors    bad_argument; the message says why a value is refused, without the option's name.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "render/options/picture_options.h"
#include "stormcellar/base/result.h"

namespace stormcellar::render {

inline constexpr double option_units_per_km = 1000;

void set_section(PictureSettings to, std::span<const double> ends);
void set_camera(PictureSettings to, std::span<const double> at);
void set_look_at(PictureSettings to, std::span<const double> at);
void set_sun(PictureSettings to, std::span<const double> sun);
[[nodiscard]] Status set_light_kinds(PictureSettings to, const std::string& names);
[[nodiscard]] std::string light_kinds(PictureSettings to);
[[nodiscard]] Status set_units(PictureSettings to, const std::string& names);
[[nodiscard]] std::string units_set(PictureSettings to);

// Reads the two ends of a section from a text of numbers or names of places. The message names the
// option.
[[nodiscard]] Result<std::vector<double>> read_section(const std::string& option,
                                                       const std::string& text);

[[nodiscard]] Status check_product(const std::string& name);
[[nodiscard]] Status check_theme(const std::string& name);
[[nodiscard]] Status check_moment(const std::string& name);
[[nodiscard]] Status check_time_zone(const std::string& zone);
[[nodiscard]] Status check_colors(const std::string& name);
[[nodiscard]] Status check_smoothing(const std::string& name);
// Return the known names, for help.
[[nodiscard]] std::string known_moments();
[[nodiscard]] std::string known_dealiasings();
[[nodiscard]] Status check_dealiasing(const std::string& name);
[[nodiscard]] std::string known_motions();
[[nodiscard]] Status check_motion(const std::string& text);
[[nodiscard]] std::string known_smoothings();

// Returns true if colors come from a file and not from a table by name.
[[nodiscard]] bool is_color_file(const std::string& name);
// Returns the name of a table unchanged, and resolves the name of a file in the directory of the
// scene file.
[[nodiscard]] std::string colors_beside(const std::filesystem::path& directory,
                                        const std::string& name);

}  // namespace stormcellar::render

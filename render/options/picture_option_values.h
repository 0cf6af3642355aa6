// render/options/picture_option_values.h -- functions for picture options whose value is more than
// a field. The functions check and set the value; the table (picture_option_rows.cpp) names the
// functions.
//
// Threads   Pure, except that they change the settings that they are given.
// Errors    bad_argument. The message gives the reason for the refusal without the option's name.
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
void set_freezing_levels(PictureSettings to, std::span<const double> heights_m);
void set_sun(PictureSettings to, std::span<const double> sun);
[[nodiscard]] Status set_light_kinds(PictureSettings to, const std::string& names);
[[nodiscard]] std::string light_kinds(PictureSettings to);
[[nodiscard]] Status set_units(PictureSettings to, const std::string& names);
[[nodiscard]] std::string units_set(PictureSettings to);

// Reads the two ends of a section from a text with numbers or with names of places. An error's
// message names the option.
[[nodiscard]] Result<std::vector<double>> read_section(const std::string& option,
                                                       const std::string& text);

[[nodiscard]] Status check_product(const std::string& name);
[[nodiscard]] Status check_theme(const std::string& name);
[[nodiscard]] Status check_moment(const std::string& name);
[[nodiscard]] Status check_time_zone(const std::string& zone);
[[nodiscard]] Status check_colors(const std::string& name);
[[nodiscard]] Status check_smoothing(const std::string& name);
[[nodiscard]] Status check_overlay(const std::string& words);
// Returns the words of an overlay with the names of files resolved in this directory, which is that
// of the scene file.
[[nodiscard]] std::string overlay_beside(const std::filesystem::path& directory,
                                         const std::string& words);
// Return the known names, for help.
[[nodiscard]] std::string known_overlays();
[[nodiscard]] std::string known_moments();
[[nodiscard]] std::string known_dealiasings();
[[nodiscard]] Status check_dealiasing(const std::string& name);
[[nodiscard]] std::string known_motions();
[[nodiscard]] Status check_motion(const std::string& text);
[[nodiscard]] std::string known_smoothings();

// Returns true if the colors are in a file. Returns false if they are a table by name.
[[nodiscard]] bool is_color_file(const std::string& name);
// Returns the name of a table unchanged. Resolves the name of a file in the directory of the scene
// file.
[[nodiscard]] std::string colors_beside(const std::filesystem::path& directory,
                                        const std::string& name);

}  // namespace stormcellar::render

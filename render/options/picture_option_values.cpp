#include "render/options/picture_option_values.h"

#include <algorithm>
#include <cctype>

#include "base/local_time.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/split.h"
#include "grid/frame/named_place.h"
#include "render/color/built_in_tables.h"
#include "render/color/color_file.h"
#include "render/options/moment_name.h"
#include "render/options/scene_options.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {

void set_section(PictureSettings to, std::span<const double> ends) {
    to.scene.section = SectionLine{{ends[0], ends[1]}, {ends[2], ends[3]}};
}

Result<std::vector<double>> read_section(const std::string& option, const std::string& text) {
    const auto ends = grid::parse_two_places(option, text);
    if (!ends) return pass_on(ends);
    return std::vector{(*ends)[0].latitude_deg, (*ends)[0].longitude_deg, (*ends)[1].latitude_deg,
                       (*ends)[1].longitude_deg};
}

void set_camera(PictureSettings to, std::span<const double> at) {
    to.scene.camera.eye =
        Eye{at[0] * option_units_per_km, at[1] * option_units_per_km, at[2] * option_units_per_km};
}

void set_look_at(PictureSettings to, std::span<const double> at) {
    to.scene.camera.look_at =
        Eye{at[0] * option_units_per_km, at[1] * option_units_per_km, at[2] * option_units_per_km};
}

void set_freezing_levels(PictureSettings to, std::span<const double> heights_m) {
    to.scene.freezing_levels = {heights_m[0], heights_m[1]};
}

void set_sun(PictureSettings to, std::span<const double> sun) {
    to.scene.light.sun_azimuth_deg = sun[0];
    to.scene.light.sun_elevation_deg = sun[1];
}

Status set_light_kinds(PictureSettings to, const std::string& names) {
    return set_light(names, to.scene.light);
}

std::string light_kinds(PictureSettings to) {
    return light_names(to.scene.light);
}

Status set_units(PictureSettings to, const std::string& names) {
    const auto units = units_from_names(names);
    if (!units) return pass_on(units);
    to.scene.units = *units;
    return {};
}

std::string units_set(PictureSettings to) {
    return unit_names(to.scene.units);
}

Status check_product(const std::string& name) {
    const auto product = product_from_name(name);
    return product ? Status{} : pass_on(product);
}

Status check_theme(const std::string& name) {
    const auto theme = theme_from_name(name);
    return theme ? Status{} : pass_on(theme);
}

std::string known_moments() {
    return level2::moment_names(", ", " or ");
}

Status check_moment(const std::string& name) {
    const auto moment = moment_named(name);
    return moment ? Status{} : pass_on(moment);
}

std::string known_dealiasings() {
    return retrieve::dealiasing_names();
}

Status check_dealiasing(const std::string& name) {
    const auto rung = retrieve::dealiasing_from_name(name);
    return rung ? Status{} : pass_on(rung);
}

std::string known_motions() {
    return retrieve::motion_choices();
}

Status check_motion(const std::string& text) {
    const auto motion = retrieve::motion_choice_from(text);
    return motion ? Status{} : pass_on(motion);
}

Status check_time_zone(const std::string& zone) {
    if (format_local(UtcTime{}, zone)) return {};
    return fail(ErrorCode::bad_argument, "the time zone '{}' is not known on this machine",
                printable(zone));
}

Status check_colors(const std::string& name) {
    if (table_of_family(name, level2::Moment::ref) != nullptr) return {};
    const auto table = colors_from(name);
    if (table) return {};
    const std::vector<std::string> families(color_families.begin(), color_families.end());
    if (const std::string meant = did_you_mean(name, families); !meant.empty())
        return fail(ErrorCode::bad_argument, "there is no color table '{}'{}", printable(name),
                    meant);
    return pass_on(table);
}

std::string known_smoothings() {
    return "cubic or none";
}

Status check_smoothing(const std::string& name) {
    if (name == "cubic" || name == "none") return {};
    return fail(ErrorCode::bad_argument, "must be {}, not '{}'", known_smoothings(),
                printable(name));
}

std::string known_overlays() {
    return std::string(overlay_cells);
}

Status check_overlay(const std::string& words) {
    for (const std::string_view word : split(words, ',')) {
        const bool is_file = word.find_first_of("./") != std::string_view::npos;
        if (word == overlay_cells || is_file) continue;
        return fail(ErrorCode::bad_argument,
                    "must be {}, or a file of GeoJSON or a placefile, or both with a comma between "
                    "them, not '{}'",
                    known_overlays(), printable(word));
    }
    return {};
}

std::string overlay_beside(const std::filesystem::path& directory, const std::string& words) {
    std::string all;
    for (const std::string_view word : split(words, ',')) {
        if (!all.empty()) all += ',';
        all += word == overlay_cells ? std::string(word) : (directory / word).native();
    }
    return all;
}

bool is_color_file(const std::string& name) {
    std::string ending = std::filesystem::path(name).extension().native();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending == ".pal" || ending == ".toml";
}

std::string colors_beside(const std::filesystem::path& directory, const std::string& name) {
    return is_color_file(name) ? (directory / name).native() : name;
}

}  // namespace stormcellar::render

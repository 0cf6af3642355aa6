// stormcellar profile FILE...: prints the wind above a radar by height, and draws it.
#include <algorithm>
#include <memory>
#include <set>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "cli/shared/commands.h"
#include "cli/shared/output_file.h"
#include "cli/velocity/profile_text.h"
#include "cli/velocity/velocity_input.h"
#include "render/wind/hodograph.h"
#include "render/wind/time_height.h"
#include "stormcellar/render/png_file.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {
namespace {

using retrieve::StationProfile;

constexpr double per_km = 1000;

struct ProfileOptions {
    std::vector<std::string> files;
    bool json = false;
    std::string plot;  // PNG file to write; empty: none
    std::string units, theme = std::string(render::theme_name(render::Theme::dark));
    int width = 900, height = 900;
    double layer_m = retrieve::WindProfileOptions{}.layer_m;
    double reach_km = retrieve::WindProfileOptions{}.most_range_m / per_km;
    int threads = 0;  // 0: as many as the machine has
    SiteOptions site;
};

// The options, parsed.
struct ProfileWish {
    retrieve::WindProfileOptions wind;
    SiteRequest site;
    int threads = 1;
    render::Units units;
    render::Theme theme = render::Theme::dark;
};

Result<ProfileWish> parse(const ProfileOptions& options) {
    ProfileWish wish;
    if (!options.plot.empty()) {
        const Status good =
            check_output_file(options.plot, {".png"}, "a profile is drawn as PNG", options.json);
        if (!good) return pass_on(good);
    }
    if (!options.units.empty()) {
        const auto units = render::units_from_names(options.units);
        if (!units) return fail(ErrorCode::bad_argument, "--units: {}", units.error().message);
        wish.units = *units;
    }
    const auto theme = render::theme_from_name(options.theme);
    if (!theme) return fail(ErrorCode::bad_argument, "--theme: {}", theme.error().message);
    wish.theme = *theme;
    auto site = parse_site(options.site);
    if (!site) return pass_on(site);
    wish.site = *site;
    wish.wind.layer_m = options.layer_m;
    wish.wind.most_range_m = options.reach_km * per_km;
    wish.threads = options.threads > 0
                       ? options.threads
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return wish;
}

// Returns the profile of each volume of a file. Errors name the file.
Result<std::vector<StationProfile>> profiles_of(InputFiles& inputs, const InputFile& file,
                                                const ProfileWish& wish) {
    const auto volumes = placed_volumes(inputs, file, wish.site, wish.threads);
    if (!volumes) return pass_on(volumes);
    std::vector<StationProfile> profiles;
    for (const level2::Volume& volume : *volumes) {
        auto profile = retrieve::station_profile(volume, file.file_name(), wish.wind);
        if (!profile) {
            const bool lacks_place = profile.error().code == ErrorCode::not_found;
            return fail(profile.error().code, "{}: {}{}", file.label, profile.error().message,
                        lacks_place ? how_to_place : "");
        }
        profiles.push_back(std::move(*profile));
    }
    return profiles;
}

struct FoundProfiles {
    std::vector<StationProfile> profiles;
    int status = exit_done;
};

// Reads all files. Files that cannot be read are reported and left out.
FoundProfiles find_profiles(InputFiles& inputs, const ProfileWish& wish) {
    FoundProfiles found;
    for (const InputFile& file : inputs.files()) {
        auto profiles = profiles_of(inputs, file, wish);
        if (profiles) {
            std::ranges::move(*profiles, std::back_inserter(found.profiles));
        } else if (file.was_found && is_no_volume(profiles.error())) {
            print_note(fmt::format("left out: {}", profiles.error().message));
        } else {
            found.status = report_error(profiles.error());
        }
    }
    return found;
}

// Draws one profile as a hodograph, and several of one station by time and height.
Result<render::Image> draw(const ProfileOptions& options, const ProfileWish& wish,
                           std::vector<StationProfile> profiles) {
    std::erase_if(profiles, [](const StationProfile& profile) { return !profile.has_wind(); });
    const auto fonts = render::Fonts::load();
    if (!fonts) return pass_on(fonts);
    render::WindPage page{.width = options.width,
                          .height = options.height,
                          .theme = wish.theme,
                          .units = wish.units,
                          .station = profiles.front().station,
                          .antenna_altitude_m = profiles.front().antenna_altitude_m,
                          .method = method_text(wish.wind)};
    std::ranges::stable_sort(profiles, {}, &StationProfile::time);
    std::vector<render::WindColumn> columns;
    for (const StationProfile& profile : profiles)
        columns.push_back({profile.time.value_or(UtcTime{}), profile.layers});
    if (columns.size() == 1)
        return render::draw_hodograph(page, columns.front(), profiles.front().motions, *fonts);
    return render::draw_time_height(page, columns, *fonts);
}

Status check_one_station(const std::vector<StationProfile>& profiles) {
    std::set<std::string> stations;
    for (const StationProfile& profile : profiles)
        stations.insert(profile.station);
    if (stations.size() < 2) return {};
    return fail(ErrorCode::bad_argument, "--plot draws one station, and the files are of {}",
                fmt::join(stations, ", "));
}

Status write_plot(const ProfileOptions& options, const ProfileWish& wish,
                  const std::vector<StationProfile>& profiles) {
    const auto image = draw(options, wish, profiles);
    if (!image) return pass_on(image);
    const auto png = render::encode_png(*image);
    if (!png) return pass_on(png);
    return write_output(options.plot, *png);
}

void print_profiles(const ProfileOptions& options, const ProfileWish& wish,
                    const std::vector<StationProfile>& profiles, bool is_drawn) {
    if (options.json) {
        nlohmann::ordered_json document = {{"profiles", nlohmann::ordered_json::array()}};
        for (const StationProfile& profile : profiles)
            document["profiles"].push_back(retrieve::profile_json(profile));
        if (is_drawn) document["written"] = options.plot;
        print_document(document);
        return;
    }
    if (is_stdout(options.plot)) return;
    for (std::size_t i = 0; i < profiles.size(); ++i)
        fmt::print("{}{}", i > 0 ? "\n" : "", profile_table(profiles[i], wish.wind, wish.units));
    if (is_drawn) fmt::print("\n{}: written\n", printable(options.plot));
}

int run_profile(const ProfileOptions& options) {
    const auto wish = parse(options);
    if (!wish) return report_error(wish.error());
    auto inputs = InputFiles::find(options.files);
    if (!inputs) return report_error(inputs.error());
    note_left_out(*inputs);
    const auto [profiles, status] = find_profiles(*inputs, *wish);
    if (profiles.empty() && status != exit_done) return status;
    if (profiles.empty())
        return report_error({ErrorCode::not_level2,
                             fmt::format("{}: no Level II file", fmt::join(options.files, ", "))});
    const bool has_wind = std::ranges::any_of(profiles, &StationProfile::has_wind);
    const bool is_drawn = !options.plot.empty() && has_wind;
    if (is_drawn) {
        if (const Status one = check_one_station(profiles); !one) return report_error(one.error());
        const Status written = write_plot(options, *wish, profiles);
        if (!written) return report_error(written.error());
    }
    print_profiles(options, *wish, profiles, is_drawn);
    if (has_wind || status != exit_done) return status;
    if (!options.plot.empty()) print_note("no layer has a wind, so nothing is drawn");
    return exit_nothing_matched;
}

}  // namespace

Run set_up_profile(CLI::App& profile) {
    const auto options = std::make_shared<ProfileOptions>();
    profile
        .add_option("FILE", options->files,
                    "Level II files, tar or zip archives of them, directories, or - for standard "
                    "input")
        ->required();
    profile.add_flag("--json", options->json,
                     "Print one JSON document, in meters above sea level and m/s");
    profile.add_option("--plot", options->plot,
                       "Also draw this PNG file: a hodograph of one volume, or several volumes of "
                       "one station by time and height");
    profile.add_option("--units", options->units,
                       "Units of speeds and heights, separated by commas, as in knots,kft: " +
                           render::units_for_help());
    profile.add_option("--layer-m", options->layer_m, "Thickness of a layer in meters")
        ->check(CLI::Range(50, 2000));
    profile
        .add_option("--reach-km", options->reach_km,
                    "Greatest range of the gates in km; gates nearer than 5 km are left out")
        ->check(CLI::Range(6, 300));
    profile.add_option("--theme", options->theme,
                       "The page on which the picture is drawn: " + render::themes_for_help());
    const CLI::Range side(static_cast<int>(render::limits::side_px.least),
                          static_cast<int>(render::limits::side_px.most));
    profile.add_option("--width", options->width, "Width of the picture in pixels")->check(side);
    profile.add_option("--height", options->height, "Height of the picture in pixels")->check(side);
    add_site_options(profile, options->site);
    profile
        .add_option("--threads", options->threads,
                    "Number of threads for decompression. Default: all processors")
        ->check(CLI::Range(1, 256));
    return [options] { return run_profile(*options); };
}

}  // namespace stormcellar::cli

// stormcellar cyclone FILE: finds the center, the wind and the pressure of a hurricane.
#include <cmath>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "base/number_list.h"
#include "cli/shared/commands.h"
#include "cli/velocity/cyclone_text.h"
#include "cli/velocity/velocity_input.h"

namespace stormcellar::cli {
namespace {

struct CycloneCommand {
    std::string file;
    std::string near;       // LAT,LON; empty: search
    std::string mean_wind;  // EAST,NORTH; empty: unknown
    bool json = false;
    SiteOptions site;
};

constexpr double most_wind_mps = 50;

Result<retrieve::CycloneOptions> parse_cyclone(const CycloneCommand& command) {
    retrieve::CycloneOptions options;
    if (!command.near.empty()) {
        const auto given = parse_numbers(command.near, ',');
        if (!given || given->size() != 2 || !(std::abs((*given)[0]) <= 90) ||
            !(std::abs((*given)[1]) <= 180)) {
            return fail(ErrorCode::bad_argument,
                        "--near takes LAT,LON in degrees, as in 28.1,-97.0, not '{}'",
                        command.near);
        }
        options.near = grid::GeoPoint{(*given)[0], (*given)[1]};
    }
    if (!command.mean_wind.empty()) {
        const auto given = parse_numbers(command.mean_wind, ',');
        if (!given || given->size() != 2 || !(std::abs((*given)[0]) <= most_wind_mps) ||
            !(std::abs((*given)[1]) <= most_wind_mps)) {
            return fail(ErrorCode::bad_argument,
                        "--mean-wind takes EAST,NORTH in m/s, up to 50, as in -2,3, not '{}'",
                        command.mean_wind);
        }
        options.mean_wind = retrieve::HorizontalWind{(*given)[0], (*given)[1]};
    }
    return options;
}

// Reads the file, which must have one volume.
Result<level2::Volume> read_volume(const CycloneCommand& command) {
    const auto site = parse_site(command.site);
    if (!site) return pass_on(site);
    auto inputs = InputFiles::find({command.file});
    if (!inputs) return pass_on(inputs);
    if (inputs->files().size() != 1) {
        return fail(ErrorCode::bad_argument, "{}: holds {} files; name one of them, such as {}",
                    command.file, inputs->files().size(), inputs->files().front().label);
    }
    auto volumes = placed_volumes(*inputs, inputs->files().front(), *site, 1);
    if (!volumes) return pass_on(volumes);
    if (volumes->size() != 1) {
        return fail(ErrorCode::unsupported, "{}: holds {} volumes, and a hurricane needs one",
                    command.file, volumes->size());
    }
    return std::move(volumes->front());
}

int run_cyclone(const CycloneCommand& command) {
    const auto options = parse_cyclone(command);
    if (!options) return report_error(options.error());
    const auto volume = read_volume(command);
    if (!volume) return report_error(volume.error());
    auto cyclone = retrieve::find_cyclone(
        *volume, retrieve::dealias(*volume, retrieve::Dealiasing::anchored), *options);
    if (!cyclone) {
        if (command.json) print_document(no_cyclone_json(cyclone.error()));
        report_error({ErrorCode::unmet, fmt::format("{}: {}", command.file, cyclone.error().text)});
        return exit_nothing_matched;
    }
    const auto antenna = level2::antenna_position(*volume);
    const StationCyclone found{volume->station, volume->start_time(),
                               antenna ? antenna->altitude_m : 0, std::move(*cyclone)};
    if (command.json)
        print_document(cyclone_json(found));
    else
        fmt::print("{}", cyclone_table(found));
    return exit_done;
}

}  // namespace

Run set_up_cyclone(CLI::App& cyclone) {
    const auto command = std::make_shared<CycloneCommand>();
    cyclone
        .add_option("FILE", command->file,
                    "A Level II file of one volume, a directory of its chunks, or - for standard "
                    "input")
        ->required();
    cyclone.add_option("--near", command->near,
                       "First guess of the center: LAT,LON in degrees, at most 40 km off. Default: "
                       "search all that the velocities reach");
    cyclone.add_option("--mean-wind", command->mean_wind,
                       "Wind that carries the hurricane: EAST,NORTH in m/s. Its part across the "
                       "beam corrects the tangential wind. Default: unknown, which widens the "
                       "errors");
    cyclone.add_flag("--json", command->json,
                     "Print one JSON document with all rings, or the reason why there is no "
                     "hurricane");
    add_site_options(cyclone, command->site);
    return [command] { return run_cyclone(*command); };
}

}  // namespace stormcellar::cli

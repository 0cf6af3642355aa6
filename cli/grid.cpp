// stormcellar grid FILE -o OUT.nc: decode a volume, grid it, write it as netCDF.
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/file_system.h"
#include "base/station_table.h"
#include "cli/commands.h"
#include "cli/problem_notes.h"
#include "export/grid_netcdf.h"
#include "grid/column_geometry.h"
#include "grid/gridder.h"
#include "level2/decode.h"

namespace stormcellar::cli {
namespace {

struct GridOptions {
    std::vector<std::string> files;
    std::string output;
    std::string center;
    std::string extent_km;
    double spacing_km = 1;
    std::string levels_km;
    std::string moment = "REF";
    int threads = 0;  // 0: as many as the machine has
    bool json = false;
};

// What the options say, before the site is known.
struct GridRequest {
    std::optional<std::array<double, 2>> center_deg;
    grid::GridSpec spec;  // but for its centre
    level2::Moment moment = level2::Moment::ref;
    int threads = 1;
};

struct Timings {
    double read_s = 0, decode_s = 0, geometry_s = 0, grid_s = 0, write_s = 0, total_s = 0;
};

class Stopwatch {
  public:
    double lap_s() {
        const auto now = Clock::now();
        const std::chrono::duration<double> lap = now - last_;
        last_ = now;
        return lap.count();
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point last_ = Clock::now();
};

// Numbers with a separator between them; none when anything else stands there.
std::optional<std::vector<double>> parse_numbers(std::string_view text, char separator) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        double number = 0;
        const auto [stopped, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
        numbers.push_back(number);
        if (stopped == end) return numbers;
        if (*stopped != separator) return std::nullopt;
        at = stopped + 1;
    }
}

// To the millimetre, so that 0.1 km is 100 m and nothing else.
double metres(double km) {
    return std::round(km * 1e6) / 1e3;
}

Result<std::vector<double>> parse_levels(const std::string& text) {
    std::vector<double> levels_m;
    if (text.find(':') == std::string::npos) {
        const auto levels_km = parse_numbers(text, ',');
        if (!levels_km) {
            return fail(ErrorCode::bad_argument,
                        "--levels-km takes numbers a,b,c or bottom:top:step, not '{}'", text);
        }
        for (const double level_km : *levels_km)
            levels_m.push_back(metres(level_km));
        return levels_m;
    }
    const auto range = parse_numbers(text, ':');
    const bool sensible =
        range && range->size() == 3 && (*range)[2] > 0 && (*range)[1] >= (*range)[0];
    if (!sensible) {
        return fail(ErrorCode::bad_argument,
                    "--levels-km takes bottom:top:step with a top above the bottom and a step "
                    "above 0, not '{}'",
                    text);
    }
    const double steps = std::floor(((*range)[1] - (*range)[0]) / (*range)[2] + 1e-6);
    if (steps > 1e4) return fail(ErrorCode::bad_argument, "--levels-km {}: too many levels", text);
    for (int step = 0; step <= static_cast<int>(steps); ++step)
        levels_m.push_back(metres((*range)[0] + step * (*range)[2]));
    return levels_m;
}

// How many cells make up an extent; it must be a whole number.
Result<int> cells_along(double extent_km, double spacing_km) {
    const double cells = std::round(extent_km / spacing_km);
    const bool whole = std::abs(cells * spacing_km - extent_km) <= 1e-6 * extent_km;
    if (!(cells >= 1 && cells <= 1e6) || !whole) {
        return fail(ErrorCode::bad_argument, "an extent of {} km is no whole number of {} km cells",
                    extent_km, spacing_km);
    }
    return static_cast<int>(cells);
}

Status parse_extent(const GridOptions& options, grid::GridSpec& spec) {
    if (!(options.spacing_km > 0)) {
        return fail(ErrorCode::bad_argument, "--spacing-km must be above 0, not {}",
                    options.spacing_km);
    }
    std::vector<double> extent_km = {460, 460};
    if (!options.extent_km.empty()) {
        const auto given = parse_numbers(options.extent_km, ',');
        if (!given || given->size() != 2) {
            return fail(ErrorCode::bad_argument, "--extent-km takes width,height, not '{}'",
                        options.extent_km);
        }
        extent_km = *given;
    }
    const auto nx = cells_along(extent_km[0], options.spacing_km);
    if (!nx) return pass_on(nx);
    const auto ny = cells_along(extent_km[1], options.spacing_km);
    if (!ny) return pass_on(ny);
    spec.nx = *nx;
    spec.ny = *ny;
    spec.spacing_m = metres(options.spacing_km);
    return {};
}

Result<GridRequest> parse_request(const GridOptions& options) {
    if (options.files.size() != 1) {
        return fail(ErrorCode::bad_argument, "grid takes one FILE, not {}", options.files.size());
    }
    GridRequest request;
    request.spec = grid::default_spec(0, 0);
    if (auto done = parse_extent(options, request.spec); !done) return pass_on(done);
    if (!options.levels_km.empty()) {
        const auto levels_m = parse_levels(options.levels_km);
        if (!levels_m) return pass_on(levels_m);
        request.spec.levels_m = *levels_m;
    }
    if (!options.center.empty()) {
        const auto center = parse_numbers(options.center, ',');
        if (!center || center->size() != 2) {
            return fail(ErrorCode::bad_argument, "--center takes LAT,LON in degrees, not '{}'",
                        options.center);
        }
        request.center_deg = {(*center)[0], (*center)[1]};
        request.spec.center_latitude_deg = (*center)[0];
        request.spec.center_longitude_deg = (*center)[1];
    }
    const auto moment = level2::moment_from_name(options.moment);
    if (!moment) {
        std::vector<std::string_view> names;
        names.reserve(level2::all_moments.size());
        for (const level2::Moment known : level2::all_moments)
            names.push_back(level2::moment_name(known));
        return fail(ErrorCode::bad_argument, "--moment takes one of {}, not '{}'",
                    fmt::join(names, " "), options.moment);
    }
    request.moment = *moment;
    if (auto valid = grid::validate(request.spec); !valid) return pass_on(valid);
    request.threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return request;
}

bool holds(const level2::Volume& volume, level2::Moment moment) {
    return std::any_of(volume.sweeps.begin(), volume.sweeps.end(),
                       [&](const level2::Sweep& sweep) { return sweep.find(moment) != nullptr; });
}

Result<level2::Decoded> read_and_decode(const std::filesystem::path& path, int threads,
                                        level2::Moment moment, Stopwatch& watch, Timings& timings) {
    const auto bytes = read_file(path);
    timings.read_s = watch.lap_s();
    if (!bytes) return pass_on(bytes);
    level2::DecodeOptions options;
    options.threads = threads;
    options.selection.moments = {moment};
    const std::string name = path.filename().string().substr(0, 4);
    if (find_station(name)) options.fallback_station = name;
    auto decoded = level2::decode(*bytes, options);
    timings.decode_s = watch.lap_s();
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", path.string(), decoded.error().message);
    }
    return decoded;
}

// The first volume of a file that holds the moment; of a file with several, a note says so.
level2::Volume take_volume(level2::Decoded decoded, level2::Moment moment,
                           std::vector<std::string>& notes) {
    std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    const auto found = std::find_if(volumes.begin(), volumes.end(),
                                    [&](const auto& volume) { return holds(volume, moment); });
    const std::size_t index =
        found == volumes.end() ? 0 : static_cast<std::size_t>(found - volumes.begin());
    if (volumes.size() > 1) {
        notes.push_back(
            fmt::format("the file holds {} volumes; this is number {}", volumes.size(), index + 1));
    }
    return std::move(volumes[index]);
}

Result<grid::Grid> grid_file(const std::filesystem::path& path, const GridRequest& request,
                             Timings& timings) {
    Stopwatch watch;
    auto decoded = read_and_decode(path, request.threads, request.moment, watch, timings);
    if (!decoded) return pass_on(decoded);
    const bool partial = !decoded->report.complete;
    std::vector<std::string> notes = notes_of(decoded->report);
    const level2::Volume volume = take_volume(std::move(*decoded), request.moment, notes);
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) {
        return fail(ErrorCode::not_found,
                    "{}: neither the file nor the station table says where the radar stands",
                    path.string());
    }
    if (antenna->disagreement) notes.push_back(*antenna->disagreement);
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    grid::GridSpec spec = request.spec;
    if (!request.center_deg) {
        spec.center_latitude_deg = site.latitude_deg;
        spec.center_longitude_deg = site.longitude_deg;
    }
    watch.lap_s();
    const auto geometry = grid::make_column_geometry(site, spec);
    timings.geometry_s = watch.lap_s();
    if (!geometry) return pass_on(geometry);
    auto made = grid::make_grid(volume, site, **geometry, {request.moment, 0, request.threads});
    timings.grid_s = watch.lap_s();
    if (!made) return fail(made.error().code, "{}: {}", path.string(), made.error().message);
    made->provenance.source_files = {path.filename().string()};
    made->provenance.partial = partial;
    made->provenance.notes.insert(made->provenance.notes.begin(), notes.begin(), notes.end());
    return made;
}

std::array<std::size_t, 4> count_states(const grid::Grid& grid) {
    std::array<std::size_t, 4> counts{};
    for (const grid::CellStatus status : grid.status)
        ++counts[static_cast<std::size_t>(status)];
    return counts;
}

nlohmann::ordered_json describe(const GridOptions& options, const grid::Grid& grid,
                                const Timings& timings) {
    nlohmann::ordered_json json;
    json["file"] = std::filesystem::path(options.files.front()).filename().string();
    json["output"] = options.output;
    json["station"] = grid.sites.front().icao;
    json["time"] = format_utc(grid.time);
    json["moment"] = level2::moment_name(grid.moment);
    json["units"] = level2::moment_units(grid.moment);
    json["projection"] = grid::projection_name(grid.spec.projection);
    json["center"] = {grid.spec.center_latitude_deg, grid.spec.center_longitude_deg};
    json["spacing_m"] = grid.spec.spacing_m;
    json["nx"] = grid.spec.nx;
    json["ny"] = grid.spec.ny;
    json["levels_m"] = grid.spec.levels_m;
    const auto counts = count_states(grid);
    for (std::size_t state = 0; state < counts.size(); ++state)
        json["cells"][std::string{grid::cell_status_name(static_cast<grid::CellStatus>(state))}] =
            counts[state];
    json["method"] = grid.provenance.method;
    json["beam_model"] = grid.provenance.beam_model;
    json["averaging"] = grid.provenance.averaging;
    json["partial"] = grid.provenance.partial;
    json["notes"] = grid.provenance.notes;
    json["read_s"] = timings.read_s;
    json["decode_s"] = timings.decode_s;
    json["geometry_s"] = timings.geometry_s;
    json["grid_s"] = timings.grid_s;
    json["write_s"] = timings.write_s;
    json["total_s"] = timings.total_s;
    return json;
}

void print_facts(const GridOptions& options, const grid::Grid& grid, const Timings& timings) {
    const auto counts = count_states(grid);
    const auto percent = [&](grid::CellStatus status) {
        return 100.0 * static_cast<double>(counts[static_cast<std::size_t>(status)]) /
               static_cast<double>(grid.status.size());
    };
    fmt::print("{}: {} {} of {}, {} x {} x {} cells at {} km\n", printable(options.output),
               printable(grid.sites.front().icao), level2::moment_name(grid.moment),
               format_utc(grid.time), grid.spec.nx, grid.spec.ny, grid.spec.nz(),
               grid.spec.spacing_m / 1000);
    fmt::print(
        "  {:.1f} % with a value, {:.1f} % no echo, {:.1f} % range folded, {:.1f} % not "
        "seen\n",
        percent(grid::CellStatus::value), percent(grid::CellStatus::no_echo),
        percent(grid::CellStatus::range_folded), percent(grid::CellStatus::not_seen));
    for (const std::string& note : grid.provenance.notes)
        fmt::print("  note: {}\n", printable(note));
    fmt::print(
        "  read {:.3f} s, decode {:.3f} s, geometry {:.3f} s, grid {:.3f} s, write {:.3f} "
        "s\n",
        timings.read_s, timings.decode_s, timings.geometry_s, timings.grid_s, timings.write_s);
}

int run_grid(const GridOptions& options) {
    Stopwatch total;
    const auto request = parse_request(options);
    if (!request) return report_error(request.error());
    Timings timings;
    std::error_code ignored;
    if (std::filesystem::equivalent(options.files.front(), options.output, ignored)) {
        return report_error(
            {ErrorCode::bad_argument, fmt::format("{}: is the volume itself", options.output)});
    }
    if (const Status writable = check_target(options.output); !writable) {
        return report_error(writable.error());
    }
    const auto made = grid_file(options.files.front(), *request, timings);
    if (!made) return report_error(made.error());
    Stopwatch watch;
    const auto written = netcdf::write_grid(real_file_system(), options.output, *made);
    if (!written) return report_error(written.error());
    timings.write_s = watch.lap_s();
    timings.total_s = total.lap_s();
    if (options.json) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        fmt::print("{}\n", describe(options, *made, timings).dump(1, ' ', false, replace));
    } else {
        print_facts(options, *made, timings);
    }
    return exit_done;
}

}  // namespace

Command add_grid(CLI::App& app) {
    const auto options = std::make_shared<GridOptions>();
    CLI::App* grid = app.add_subcommand("grid", "Grid a Level II file and write it as netCDF");
    grid->add_option("FILE", options->files, "One Level II file")->required();
    grid->add_option("-o,--output", options->output, "The netCDF file to write")->required();
    grid->add_option("--center", options->center, "LAT,LON in degrees; else the site");
    grid->add_option("--extent-km", options->extent_km,
                     "Full width and height, e.g. 460,460 (the default)");
    grid->add_option("--spacing-km", options->spacing_km, "From one cell to the next")
        ->capture_default_str();
    grid->add_option("--levels-km", options->levels_km,
                     "Heights above mean sea level, a,b,c or bottom:top:step; else 0.5:16:0.5");
    grid->add_option("--moment", options->moment, "REF, VEL, SW, ZDR, PHI, RHO or CFP")
        ->capture_default_str();
    grid->add_option("--threads", options->threads, "Else as many as the machine has")
        ->check(CLI::Range(1, 256));
    grid->add_flag("--json", options->json, "One JSON document with facts and phase timings");
    return {grid, [options] { return run_grid(*options); }};
}

}  // namespace stormcellar::cli

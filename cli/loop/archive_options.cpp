#include "cli/loop/archive_options.h"

#include <charconv>
#include <cmath>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/name_list.h"
#include "base/number_list.h"
#include "cli/grid/grid_mosaic.h"
#include "cli/shared/query_options.h"
#include "grid/cells/level_range.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::cli {
namespace {

constexpr int most_cells_a_side = 1024;  // used if no spacing was requested

// Returns a typed option that only makes sense with an archive, or an empty name if there is none.
std::string_view stray_option(const ArchiveOptions& options) {
    const GridOptions& place = options.place;
    const bool placed = !place.center.empty() || !place.parallels.empty() ||
                        !place.extent_km.empty() || !place.extent_deg.empty() || place.spacing_km ||
                        place.spacing_deg || !place.levels_km.empty() ||
                        place.projection != GridOptions{}.projection;
    if (!options.stations.empty()) return "--stations";
    if (!options.bounds.empty()) return "--bounds";
    if (!options.overlap.empty() || options.overlap_km) return "--overlap";
    if (!options.keep_cache) return "--no-keep-cache";
    return placed ? "a grid's place or size" : "";
}

// Returns a grid of whole cells that holds the bounds, in the unit of the spacing.
Result<grid::GridSpec> spec_over(const pipeline::Bounds& bounds, GridRequest request) {
    const grid::GeoPoint middle = pipeline::middle_of(bounds);
    request.extent_given = true;
    const auto whole = [&](double extent) {
        return std::ceil(extent / request.spacing - 1e-6) * request.spacing;
    };
    if (grid::facts_of(request.projection).in_degrees) {
        request.extent = {pipeline::width_deg(bounds), bounds[3] - bounds[1]};
        request.extent_unit = SizeUnit::degrees;
        if (request.spacing_unit == SizeUnit::degrees) {
            request.extent = {whole(request.extent[0]), whole(request.extent[1])};
        }
        return spec_about(request, middle.latitude_deg, middle.longitude_deg);
    }
    request.extent = {request.spacing, request.spacing};
    const auto one = spec_about(request, middle.latitude_deg, middle.longitude_deg);
    if (!one) return pass_on(one);
    const auto half = pipeline::half_columns_of(*one, bounds);
    if (!half) return pass_on(half);
    if (!(half->x > 0) || !(half->y > 0)) {
        return fail(ErrorCode::bad_argument,
                    "--bounds are too wide for a flat projection; add --projection lat-lon");
    }
    request.extent = {2 * std::ceil(half->x - 1e-6) * request.spacing,
                      2 * std::ceil(half->y - 1e-6) * request.spacing};
    return spec_about(request, middle.latitude_deg, middle.longitude_deg);
}

}  // namespace

Result<std::vector<std::string>> parse_stations(const std::string& text) {
    std::set<std::string> names;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find(',', from), text.size());
        const std::string name = text.substr(from, to - from);
        from = to + 1;
        if (!is_icao(name)) {
            return fail(
                ErrorCode::bad_argument,
                "--stations takes ICAO identifiers separated by commas, as in KBGM,KENX, not '{}'",
                text);
        }
        names.insert(name);
    }
    return std::vector<std::string>(names.begin(), names.end());
}

void add_overlap_options(CLI::App& app, ArchiveOptions& options, const std::string& group) {
    app.add_option("--overlap", options.overlap,
                   fmt::format("Rule for cells that several sites see: {} (the default)",
                               names_in(grid::overlap_facts, ", ", " or ")))
        ->group(group);
    app.add_option(
           "--overlap-km", options.overlap_km,
           "Length L in km of the weight exp(-r^2/L^2) of a site at the distance r. Default: 250")
        ->group(group)
        ->check(CLI::Range(1.0, 10'000.0));
}

void add_archive_options(CLI::App& app, ArchiveOptions& options) {
    const std::string group = "From an archive's raw files";
    app.add_option(
           "--catalog", options.catalog,
           "Directory of the catalog (state/catalog). The grids are made from the raw files of "
           "--from to --to in a cache of their own, and stay there for the next run")
        ->group(group);
    app.add_option("--stations", options.stations,
                   "ICAO identifiers of the stations, such as KBGM,KENX. One station gives its own "
                   "grid, several give a mosaic")
        ->group(group);
    app.add_option("--bounds", options.bounds,
                   "Make a mosaic of the stations that reach these bounds: WEST,SOUTH,EAST,NORTH "
                   "in degrees")
        ->group(group);
    CLI::App* place = app.add_option_group(group + ": the grid");
    add_place_options(*place, options.place);
    add_overlap_options(app, options, group);
    app.add_flag("--keep-cache,!--no-keep-cache", options.keep_cache,
                 "Keep the grids for the next run (the default), or remove them at the end")
        ->group(group);
}

Result<ArchiveRequest> parse_archive(const ArchiveOptions& options) {
    ArchiveRequest request;
    if (!options.asked()) {
        if (const auto stray = stray_option(options); !stray.empty()) {
            return fail(ErrorCode::bad_argument,
                        "{} needs --catalog, because it is for a loop from an archive", stray);
        }
        return request;
    }
    if (options.stations.empty() && options.bounds.empty()) {
        return fail(ErrorCode::bad_argument, "--catalog needs --stations or --bounds");
    }
    if (!options.stations.empty()) {
        auto stations = parse_stations(options.stations);
        if (!stations) return pass_on(stations);
        request.stations = std::move(*stations);
    }
    const bool extent_given = !options.place.extent_km.empty() || !options.place.extent_deg.empty();
    if (!options.bounds.empty()) {
        const auto bounds = parse_bounds(options.bounds);
        if (!bounds) return pass_on(bounds);
        if (!options.place.center.empty() || extent_given) {
            return fail(
                ErrorCode::bad_argument,
                "--bounds sets the place and size of the grid; leave out --center and the extent");
        }
        request.bounds = *bounds;
    }
    auto place = parse_request(options.place);
    if (!place) return pass_on(place);
    request.place = std::move(*place);
    request.spacing_given = options.place.spacing_km || options.place.spacing_deg;
    request.place_given = !options.place.center.empty() ||
                          options.place.projection != GridOptions{}.projection ||
                          request.bounds.has_value();
    if (!options.overlap.empty()) {
        request.overlap = grid::overlap_from_name(options.overlap);
        if (!request.overlap) {
            return fail(ErrorCode::bad_argument, "--overlap takes one of {}, not '{}'",
                        names_in(grid::overlap_facts, ", ", " and "), options.overlap);
        }
    }
    if (options.overlap_km) request.overlap_length_m = grid::metres_of_km(*options.overlap_km);
    return request;
}

Result<grid::GridSpec> archive_spec(const ArchiveRequest& request,
                                    const std::vector<grid::SitePosition>& sites) {
    const auto by_spacing = [&](double spacing_km) {
        GridRequest place = request.place;
        if (!request.spacing_given) place.spacing = spacing_km;
        return request.bounds ? spec_over(*request.bounds, place) : mosaic_spec(sites, place);
    };
    for (const double spacing_km : {1.0, 2.0, 4.0}) {
        auto spec = by_spacing(spacing_km);
        const bool small = spec && std::max(spec->nx, spec->ny) <= most_cells_a_side;
        if (request.spacing_given || request.place.extent_given || small) return spec;
    }
    return by_spacing(8);
}

Result<std::chrono::seconds> parse_interval(const std::string& option, const std::string& text) {
    long long count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    const std::string unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    const long long seconds = unit == "min" || unit == "m" ? 60 : unit == "h" ? 3600 : 1;
    const bool known = unit.empty() || unit == "s" || seconds != 1;
    if (error != std::errc{} || !known || count < 1 || count > 86'400 / seconds) {
        return fail(ErrorCode::bad_argument,
                    "{} takes 1 second to a day, as in 60, 90s, 5min or 1h, not '{}'", option,
                    text);
    }
    return std::chrono::seconds{count * seconds};
}

}  // namespace stormcellar::cli

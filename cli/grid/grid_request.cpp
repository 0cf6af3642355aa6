#include "cli/grid/grid_request.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/ranges.h>

#include "base/number_list.h"
#include "cli/shared/commands.h"
#include "grid/cells/level_range.h"
#include "grid/frame/named_place.h"
#include "render/options/moment_name.h"

namespace stormcellar::cli {
namespace {

Result<std::vector<double>> parse_levels(const std::string& text) {
    std::vector<double> levels_m;
    if (text.find(':') == std::string::npos) {
        const auto levels_km = parse_numbers(text, ',');
        if (!levels_km) {
            return fail(ErrorCode::bad_argument,
                        "--levels-km takes numbers a,b,c or bottom:top:step, not '{}'", text);
        }
        for (const double level_km : *levels_km)
            levels_m.push_back(grid::metres_of_km(level_km));
        return levels_m;
    }
    auto range_m = grid::parse_level_range(text);
    if (!range_m) {
        return fail(ErrorCode::bad_argument,
                    "--levels-km takes bottom:top:step with a top above the bottom, a step above 0 "
                    "and at most {} levels, not '{}'",
                    grid::GridSpec::greatest_level_count, text);
    }
    return std::move(*range_m);
}

Result<std::array<double, 2>> parse_pair(std::string_view option, std::string_view takes,
                                         const std::string& text) {
    const auto given = parse_numbers(text, ',');
    if (!given || given->size() != 2) {
        return fail(ErrorCode::bad_argument, "{} takes {}, not '{}'", option, takes, text);
    }
    return std::array<double, 2>{(*given)[0], (*given)[1]};
}

Result<grid::Projection> parse_projection(const std::string& name) {
    for (const grid::ProjectionFacts& facts : grid::projection_facts) {
        const auto& shorter = facts.short_names;
        const bool is_short =
            !name.empty() && std::find(shorter.begin(), shorter.end(), name) != shorter.end();
        if (is_short || facts.name == name) return facts.projection;
    }
    return fail(ErrorCode::bad_argument, "--projection takes one of {}, not '{}'",
                known_projections(" and "), name);
}

std::string_view unit_name(SizeUnit unit) {
    return unit == SizeUnit::km ? "km" : "degree";
}

// Returns `cells`, the number of cells of this spacing in the extent, or an error if there are too
// many.
Result<int> count_of(double cells, double extent, double spacing, SizeUnit unit) {
    constexpr int most = grid::GridSpec::greatest_side;
    if (cells <= most) return static_cast<int>(cells);
    return fail(
        ErrorCode::bad_argument,
        "an extent of {0} {2} is too large for cells of {1} {2}; the limit is {3} cells, {4} {2}",
        extent, spacing, unit_name(unit), most, most * spacing);
}

// Returns how many cells of this spacing an extent has. Errors: bad_argument if the number is not
// whole or is too large.
Result<int> cells_along(double extent, double spacing, SizeUnit unit) {
    const double cells = std::round(extent / spacing);
    const bool whole = cells >= 1 && std::abs(cells * spacing - extent) <= 1e-6 * extent;
    if (!whole) {
        return fail(ErrorCode::bad_argument,
                    "an extent of {} {} is not a whole number of cells of {} {}", extent,
                    unit_name(unit), spacing, unit_name(unit));
    }
    return count_of(cells, extent, spacing, unit);
}

// Returns how many cells cover the extent. Ignores an excess of up to a millionth of a cell as a
// rounding error.
Result<int> cells_over(double extent_deg, double spacing_deg) {
    const double cells = std::ceil(extent_deg / spacing_deg - 1e-6);
    if (!(cells >= 1)) {
        return fail(ErrorCode::bad_argument,
                    "an extent of {} degrees is too small for cells of {} degrees", extent_deg,
                    spacing_deg);
    }
    return count_of(cells, extent_deg, spacing_deg, SizeUnit::degrees);
}

// Reads the spacing and the extent, either both in kilometers or both in degrees.
Status parse_size(const GridOptions& options, GridRequest& request) {
    const bool any_degrees = options.spacing_deg || !options.extent_deg.empty();
    if (any_degrees && !grid::facts_of(request.projection).in_degrees) {
        return fail(ErrorCode::bad_argument,
                    "--spacing-deg and --extent-deg need --projection latitude_longitude");
    }
    const bool twice = (options.spacing_deg && options.spacing_km) ||
                       (!options.extent_deg.empty() && !options.extent_km.empty());
    if (twice) {
        return fail(ErrorCode::bad_argument,
                    "give the spacing once and the extent once, in km or in degrees");
    }
    request.spacing_unit = options.spacing_deg ? SizeUnit::degrees : SizeUnit::km;
    request.spacing = options.spacing_deg.value_or(options.spacing_km.value_or(request.spacing));
    if (!(request.spacing > 0)) {
        return fail(ErrorCode::bad_argument, "{} must be above 0, not {}",
                    options.spacing_deg ? "--spacing-deg" : "--spacing-km", request.spacing);
    }
    request.extent_unit = options.extent_deg.empty() ? SizeUnit::km : SizeUnit::degrees;
    const std::string& text = options.extent_deg.empty() ? options.extent_km : options.extent_deg;
    if (text.empty()) return {};
    const auto extent = parse_pair(options.extent_deg.empty() ? "--extent-km" : "--extent-deg",
                                   "width,height", text);
    if (!extent) return pass_on(extent);
    request.extent = *extent;
    request.extent_given = true;
    return {};
}

Status parse_map(const GridOptions& options, GridRequest& request) {
    const auto projection = parse_projection(options.projection);
    if (!projection) return pass_on(projection);
    request.projection = *projection;
    if (!options.center.empty()) {
        const auto center = grid::parse_place(options.center_option, options.center);
        if (!center) return pass_on(center);
        request.center_deg = {center->latitude_deg, center->longitude_deg};
    }
    if (options.parallels.empty()) return {};
    if (!grid::facts_of(request.projection).takes_parallels) {
        return fail(ErrorCode::bad_argument, "--parallels needs --projection lambert_conformal");
    }
    const auto parallels = parse_pair("--parallels", "LAT1,LAT2 in degrees", options.parallels);
    if (!parallels) return pass_on(parallels);
    request.parallels_deg = *parallels;
    return {};
}

Result<level2::Moment> parse_moment(const std::string& name) {
    const auto moment = render::moment_named(name);
    if (!moment) return fail(ErrorCode::bad_argument, "--moment {}", moment.error().message);
    return *moment;
}

constexpr std::string_view every_moment = "all";

// Reads --dealias, which turns VEL into VELD unless it is "off".
Status choose_dealiasing(const GridOptions& options, GridRequest& request,
                         std::vector<level2::Moment>& moments) {
    if (options.dealias.empty()) return {};
    const auto rung = retrieve::dealiasing_from_name(options.dealias);
    if (!rung) return fail(ErrorCode::bad_argument, "--dealias {}", rung.error().message);
    const auto derived = std::ranges::find_if(moments, level2::is_dealiased);
    const bool has_derived = derived != moments.end();
    if (*rung == retrieve::Dealiasing::off) {
        if (!has_derived || request.any_moment) return {};
        return fail(ErrorCode::bad_argument,
                    "--dealias off does not go with --moment {}, which is dealiased",
                    level2::moment_name(*derived));
    }
    request.derived.dealiasing = *rung;
    const auto has = [&](level2::Moment moment) {
        return std::ranges::find(moments, moment) != moments.end();
    };
    if (!has(level2::Moment::vel) && !has_derived)
        return fail(ErrorCode::bad_argument, "--dealias needs --moment VEL");
    if (!has(level2::Moment::veld))
        std::ranges::replace(moments, level2::Moment::vel, level2::Moment::veld);
    std::ranges::sort(moments);
    return {};
}

Status choose_quality(const GridOptions& options, GridRequest& request) {
    const bool is_share = options.quality >= 0 && options.quality <= 1;
    if (!is_share) return fail(ErrorCode::bad_argument, "--quality must be from 0 to 1");
    request.derived.quality = options.quality;
    request.derived.zero_c_m = options.zero_c_m;
    return {};
}

Status choose_motion(const GridOptions& options, GridRequest& request,
                     const std::vector<level2::Moment>& moments) {
    if (options.storm_motion.empty()) return {};
    const auto motion = retrieve::motion_choice_from(options.storm_motion);
    if (!motion) return fail(ErrorCode::bad_argument, "--storm-motion {}", motion.error().message);
    request.derived.motion = *motion;
    if (std::ranges::find(moments, level2::Moment::srv) != moments.end()) return {};
    return fail(ErrorCode::bad_argument, "--storm-motion needs --moment SRV");
}

// Reads one moment. For a command that allows several, also reads a list of moments or "all".
Status parse_moments(const GridOptions& options, GridRequest& request) {
    const std::string& text = options.moment;
    request.any_moment = options.takes_moments && text == every_moment;
    std::vector<level2::Moment> moments;
    if (request.any_moment) {
        std::ranges::copy_if(
            level2::all_moments, std::back_inserter(moments),
            [](level2::Moment moment) { return !level2::facts_of(moment).is_derived; });
    } else if (!options.takes_moments) {
        const auto moment = parse_moment(text);
        if (!moment) return pass_on(moment);
        moments = {*moment};
    } else {
        for (std::size_t from = 0; from <= text.size();) {
            const std::size_t to = std::min(text.find(',', from), text.size());
            const auto moment = parse_moment(text.substr(from, to - from));
            if (!moment) return pass_on(moment);
            moments.push_back(*moment);
            from = to + 1;
        }
        std::ranges::sort(moments);
        moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
    }
    if (Status chosen = choose_dealiasing(options, request, moments); !chosen) return chosen;
    if (Status chosen = choose_quality(options, request); !chosen) return chosen;
    if (Status chosen = choose_motion(options, request, moments); !chosen) return chosen;
    request.moment = moments.front();
    request.more_moments.assign(moments.begin() + 1, moments.end());
    return {};
}

constexpr std::string_view counts_field = "counts";
constexpr std::string_view weights_field = "weights";

// Adds a field of --fields. Returns false if no field has this name.
bool add_field(std::string_view name, bool mosaic, GridRequest& request) {
    const bool all = name == "all";
    request.site_counts = request.site_counts || name == counts_field || (all && mosaic);
    request.site_weights = request.site_weights || name == weights_field || (all && mosaic);
    const auto detail = grid::detail_from_name(name);
    for (const grid::Detail known : grid::all_details) {
        if (detail == known || (all && !mosaic)) request.details.add(known);
    }
    return all || detail || name == counts_field || name == weights_field;
}

Status parse_fields(const GridOptions& options, GridRequest& request) {
    const std::string& text = options.fields;
    if (text.empty()) return {};
    const bool mosaic = options.files.size() > 1;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t to = std::min(text.find(',', from), text.size());
        const std::string name = text.substr(from, to - from);
        from = to + 1;
        if (add_field(name, mosaic, request)) continue;
        std::vector<std::string_view> names;
        names.reserve(grid::all_details.size());
        for (const grid::Detail known : grid::all_details)
            names.push_back(grid::detail_name(known));
        return fail(
            ErrorCode::bad_argument,
            "--fields takes {} or all for one FILE, and {}, {} or all for several FILEs, not '{}'",
            fmt::join(names, ", "), counts_field, weights_field, name);
    }
    if (mosaic && request.details.any()) {
        return fail(
            ErrorCode::bad_argument,
            "--fields {}: details of single gates need one FILE; several FILEs have {} and {}",
            text, counts_field, weights_field);
    }
    if (!mosaic && (request.site_counts || request.site_weights)) {
        return fail(ErrorCode::bad_argument, "--fields {}: {} and {} need several FILEs", text,
                    counts_field, weights_field);
    }
    return {};
}

Status parse_beside(const GridOptions& options, GridRequest& request) {
    if (Status done = parse_fields(options, request); !done) return done;
    if (options.time.empty()) return {};
    const auto time = parse_utc(options.time, now_utc());
    if (!time) return fail(time.error().code, "--time: {}", time.error().message);
    request.frame_time = *time;
    return {};
}

Status size_in_metres(const GridRequest& request, grid::GridSpec& spec) {
    const auto nx = cells_along(request.extent[0], request.spacing, SizeUnit::km);
    if (!nx) return pass_on(nx);
    const auto ny = cells_along(request.extent[1], request.spacing, SizeUnit::km);
    if (!ny) return pass_on(ny);
    spec.nx = *nx;
    spec.ny = *ny;
    spec.spacing_m = grid::metres_of_km(request.spacing);
    return {};
}

Status size_in_degrees(const GridRequest& request, grid::GridSpec& spec) {
    const grid::DegreeLength degree = grid::degree_length(spec.center_latitude_deg);
    const std::array<double, 2> degree_m = {degree.east_m, degree.north_m};
    const bool in_km = request.extent_unit == SizeUnit::km;
    spec.spacing_m = 0;
    spec.spacing_deg = request.spacing_unit == SizeUnit::km
                           ? grid::metres_of_km(request.spacing) / degree.north_m
                           : request.spacing;
    std::array<int, 2> counts{};
    for (std::size_t i = 0; i < 2; ++i) {
        const bool exact = !in_km && request.spacing_unit == SizeUnit::degrees;
        const double extent_deg =
            in_km ? grid::metres_of_km(request.extent[i]) / degree_m[i] : request.extent[i];
        const auto cells = exact ? cells_along(extent_deg, spec.spacing_deg, SizeUnit::degrees)
                                 : cells_over(extent_deg, spec.spacing_deg);
        if (!cells) return pass_on(cells);
        counts[i] = *cells;
    }
    spec.nx = counts[0];
    spec.ny = counts[1];
    return {};
}

}  // namespace

std::vector<level2::Moment> GridRequest::moments() const {
    std::vector<level2::Moment> all = {moment};
    all.insert(all.end(), more_moments.begin(), more_moments.end());
    return all;
}

Result<std::shared_ptr<InputFiles>> find_inputs(GridOptions& options) {
    auto inputs = InputFiles::find(options.files, options.volume);
    if (!inputs) return pass_on(inputs);
    if (options.volume > 0 && inputs->files().size() > 1) {
        return fail(ErrorCode::bad_argument, "--volume chooses a volume of one file, not of {}",
                    inputs->files().size());
    }
    options.files = inputs->labels();
    note_left_out(*inputs);
    return std::make_shared<InputFiles>(std::move(*inputs));
}

Result<GridRequest> parse_request(const GridOptions& options) {
    GridRequest request;
    if (auto done = parse_map(options, request); !done) return pass_on(done);
    if (auto done = parse_size(options, request); !done) return pass_on(done);
    if (!options.levels_km.empty()) {
        const auto levels_m = parse_levels(options.levels_km);
        if (!levels_m) return pass_on(levels_m);
        request.levels_m = *levels_m;
    }
    if (auto done = parse_moments(options, request); !done) return pass_on(done);
    auto site = parse_site(options.site);
    if (!site) return pass_on(site);
    request.site = std::move(*site);
    request.volume = options.volume;
    request.assumed_zero_c_m = options.assumed_zero_c_m;
    if (auto done = parse_beside(options, request); !done) return pass_on(done);
    request.threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    // With several sites, the default extent depends on the sites, which are not known yet.
    const bool has_extent = request.extent_given || options.files.size() == 1;
    if (has_extent && (request.center_deg || grid::facts_of(request.projection).is_polar)) {
        if (const auto spec = spec_about(request, 0, 0); !spec) return pass_on(spec);
    }
    return request;
}

Result<grid::GridSpec> spec_about(const GridRequest& request, double latitude_deg,
                                  double longitude_deg) {
    const auto center = request.center_deg.value_or(std::array{latitude_deg, longitude_deg});
    grid::GridSpec spec = grid::default_spec(center[0], center[1]);
    spec.projection = request.projection;
    if (!request.levels_m.empty()) spec.levels_m = request.levels_m;
    if (grid::facts_of(spec.projection).takes_parallels) {
        spec.parallels_deg = request.parallels_deg.value_or(std::array{center[0], center[0]});
    }
    const Status sized =
        spec.in_degrees() ? size_in_degrees(request, spec) : size_in_metres(request, spec);
    if (!sized) return pass_on(sized);
    if (auto valid = grid::validate(spec); !valid) return pass_on(valid);
    return spec;
}

}  // namespace stormcellar::cli

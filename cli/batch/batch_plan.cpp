// stormcellar batch plan --source DIR|URL --from T --to T -o PLAN: writes a plan, the file with the
// tasks that make an archive's grids.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/byte_size.h"
#include "base/name_list.h"
#include "batch/plan.h"
#include "batch/resources.h"
#include "batch/source.h"
#include "cli/batch/batch.h"
#include "cli/loop/archive_options.h"
#include "cli/shared/query_options.h"
#include "cli/shared/short_duration.h"
#include "pipeline/mosaic/domain_frames.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using batch::Recipe;
using batch::SourceListing;

struct PlanOptions {
    std::string source, output, cache, mosaic;
    TimeRangeOptions times;
    ArchiveOptions archive;  // stations, bounds, the grid and the overlap
    std::string interval{"300"};
    std::string time_method{grid::time_method_name(grid::TimeMethod::advected)};
    bool statistics = false, cell_statistics = false;
    bool json = false;
};

Result<fs::path> absolute(const std::string& path) {
    std::error_code error;
    const fs::path full = fs::absolute(path, error).lexically_normal();
    if (error) return fail(ErrorCode::io, "{}: {}", path, error.message());
    return full.has_filename() ? full : full.parent_path();
}

// Sets the source, the cache and the range.
Status take_places(const PlanOptions& options, Recipe& recipe) {
    recipe.source = options.source;
    if (!batch::is_address(options.source)) {
        const auto source = absolute(options.source);
        if (!source) return pass_on(source);
        recipe.source = source->native();
    }
    const auto cache = absolute(options.cache.empty() ? options.output + "/cache" : options.cache);
    if (!cache) return pass_on(cache);
    recipe.cache = *cache;
    const auto range = parse_time_range(options.times);
    if (!range) return pass_on(range);
    if (!range->from || !range->to) {
        return fail(ErrorCode::bad_argument, "batch plan needs --from and --to");
    }
    recipe.from = *range->from;
    recipe.to = *range->to;
    return {};
}

std::vector<grid::SitePosition> sites_of(const std::vector<std::string>& stations) {
    std::vector<grid::SitePosition> sites;
    for (const std::string& icao : stations) {
        if (const auto station = find_station(icao)) {
            sites.push_back(
                {icao, station->latitude_deg, station->longitude_deg, station->antenna_altitude_m});
        }
    }
    return sites;
}

Status check_mosaic_name(const std::string& name) {
    const bool is_plain = cache::is_domain_name(name) && !cache::is_part(name);
    if (is_plain && !is_icao(name)) return {};
    return fail(ErrorCode::bad_argument,
                "--mosaic {}: a name is up to 64 letters, digits, _ and -, and no station's", name);
}

Result<pipeline::Domain> domain_of(const PlanOptions& options, const Recipe& recipe,
                                   const std::vector<std::string>& known) {
    if (Status good = check_mosaic_name(options.mosaic); !good) return pass_on(good);
    ArchiveOptions archive = options.archive;
    archive.catalog = options.source;  // the source replaces a catalog: its volumes are used
    if (archive.stations.empty() && archive.bounds.empty())
        archive.stations = fmt::format("{}", fmt::join(known, ","));
    const auto request = parse_archive(archive);
    if (!request) return pass_on(request);
    pipeline::Domain domain;
    domain.name = options.mosaic;
    const auto derived = std::ranges::find_if(
        recipe.moments, [](level2::Moment moment) { return level2::facts_of(moment).is_derived; });
    if (derived != recipe.moments.end()) {
        return fail(ErrorCode::bad_argument,
                    "{} is made for single stations, not for mosaics; leave out --mosaic",
                    level2::moment_name(*derived));
    }
    domain.moments = recipe.moments;
    domain.stations = request->stations;
    const auto sites = sites_of(domain.stations.empty() ? known : domain.stations);
    auto spec = archive_spec(*request, sites);
    if (!spec) return pass_on(spec);
    domain.spec = std::move(*spec);
    if (domain.stations.empty()) {
        for (const grid::SitePosition& site : sites) {
            if (grid::site_window(domain.spec, site)) domain.stations.push_back(site.icao);
        }
    }
    const auto interval = parse_interval("--interval", options.interval);
    if (!interval) return pass_on(interval);
    domain.interval = *interval;
    const auto time = grid::time_method_from_name(options.time_method);
    if (!time) {
        return fail(ErrorCode::bad_argument, "--time-method takes one of {}, not '{}'",
                    names_in(grid::time_method_facts, ", ", " and "), options.time_method);
    }
    domain.time = *time;
    domain.overlap = request->overlap;
    domain.overlap_length_m = request->overlap_length_m;
    return domain;
}

// Sets the shape of the grids of single stations. Returns the named stations, or all known
// stations.
Result<std::vector<std::string>> take_own_grids(const PlanOptions& options,
                                                const std::vector<std::string>& known,
                                                Recipe& recipe) {
    const GridOptions& place = options.archive.place;
    const bool is_placed = !place.center.empty() || !place.parallels.empty() ||
                           place.projection != GridOptions{}.projection;
    if (is_placed || !options.archive.overlap.empty() || options.archive.overlap_km) {
        return fail(ErrorCode::bad_argument,
                    "a center, a projection and an overlap need --mosaic NAME");
    }
    const auto request = parse_request(place);
    if (!request) return pass_on(request);
    const auto shape = spec_about(*request, 0, 0);
    if (!shape) return pass_on(shape);
    recipe.spacing_m = shape->spacing_m;
    recipe.nx = shape->nx;
    recipe.ny = shape->ny;
    recipe.levels_m = shape->levels_m;
    if (!options.archive.stations.empty()) return cli::parse_stations(options.archive.stations);
    if (options.archive.bounds.empty()) return known;
    return stations_within(options.archive.bounds);
}

std::vector<std::string> known_stations(const Recipe& recipe, const SourceListing& listing) {
    std::set<std::string> names;
    if (batch::is_address(recipe.source)) {
        for (const Station& station : all_stations())
            names.emplace(station.icao);
    }
    for (const batch::StationDay& day : listing.days)
        names.insert(day.station);
    return {names.begin(), names.end()};
}

std::string links_text(const SourceListing& listing) {
    return fmt::format(
        "{} symbolic {} not followed, such as {}; a plan of each directory that they "
        "lead to may have the same --cache",
        listing.links, listing.links == 1 ? "link is" : "links are", listing.first_link.native());
}

// Sets the grids of the recipe and lists their raw files.
Result<SourceListing> take_stations(const PlanOptions& options, Recipe& recipe) {
    const bool is_bucket = batch::is_address(recipe.source);
    const auto margin = options.mosaic.empty()
                            ? std::chrono::milliseconds{0}
                            : std::chrono::milliseconds{pipeline::farthest_neighbour};
    const UtcTime from = recipe.from - margin, to = recipe.to + margin;
    Result<SourceListing> listing = SourceListing{};
    if (!is_bucket) listing = batch::list_source(recipe.source, from, to);
    if (!listing) return listing;
    const auto known = known_stations(recipe, *listing);
    if (known.empty()) {
        std::string more;
        if (listing->nameless > 0) {
            more = fmt::format("; {} {}, such as {}, cannot be told by station and time",
                               listing->nameless, plural(listing->nameless, "file"),
                               listing->first_nameless);
        }
        if (!listing->cut.empty()) more += "; left out: " + listing->cut.front();
        if (listing->links > 0) more += "; " + links_text(*listing);
        return fail(ErrorCode::not_found, "{}: has no volume between {} and {}{}", recipe.source,
                    format_utc(from), format_utc(to), more);
    }
    std::vector<std::string> stations;
    if (options.mosaic.empty()) {
        auto own = take_own_grids(options, known, recipe);
        if (!own) return pass_on(own);
        stations = std::move(*own);
    } else {
        auto domain = domain_of(options, recipe, known);
        if (!domain) return pass_on(domain);
        stations = domain->stations;
        recipe.domain = std::move(*domain);
        if (options.statistics) recipe.statistics = grid::Tallied::columns;
        if (options.cell_statistics) recipe.statistics = grid::Tallied::columns_and_cells;
    }
    if (is_bucket) return batch::every_day_of(stations, from, to);
    std::erase_if(listing->days, [&](const batch::StationDay& day) {
        return std::ranges::find(stations, day.station) == stations.end();
    });
    return listing;
}

std::uint64_t cache_bytes(const batch::Plan& plan) {
    const Recipe& recipe = plan.recipe();
    std::size_t frames = 0;
    if (recipe.domain) {
        frames = pipeline::instants_between(recipe.from, recipe.to, recipe.domain->interval).size();
    }
    return pipeline::bytes_of_grids(recipe.archive_options(1), plan.facts().volumes, frames) *
           recipe.moments.size();
}

void print_facts(const PlanOptions& options, const batch::Plan& plan) {
    const batch::PlanFacts& facts = plan.facts();
    const batch::Resources grids = batch::resources_of_grids(plan, 1);
    const batch::Resources frames = batch::resources_of_frames(plan, 1);
    const batch::Resources statistics = batch::resources_of_statistics(plan);
    if (options.json) {
        print_json({{"plan", plan.directory().native()},
                    {"cache", plan.recipe().cache.native()},
                    {"hash", facts.hash},
                    {"grid_tasks", facts.grid_tasks},
                    {"frame_tasks", facts.frame_tasks},
                    {"statistics_tasks", facts.statistics_tasks},
                    {"volumes", facts.volumes},
                    {"bytes", facts.bytes},
                    {"cost_s", facts.cost_s},
                    {"cache_bytes", cache_bytes(plan)},
                    {"grid_task_memory_bytes", grids.memory_bytes},
                    {"frame_task_memory_bytes", frames.memory_bytes},
                    {"statistics_task_memory_bytes", statistics.memory_bytes},
                    {"count_bytes", batch::bytes_of_counts(plan)},
                    {"scratch_bytes", grids.scratch_bytes}});
        return;
    }
    fmt::print("{}: {} {} of grids, {} of frames, {} of statistics\n",
               printable(plan.directory().native()), facts.grid_tasks,
               plural(facts.grid_tasks, "task"), facts.frame_tasks, facts.statistics_tasks);
    if (facts.volumes > 0) {
        fmt::print("  {} {}, {} of raw files; the grids take at most about {} in {}\n",
                   facts.volumes, plural(facts.volumes, "volume"), format_byte_size(facts.bytes),
                   format_byte_size(cache_bytes(plan)), printable(plan.recipe().cache.native()));
    }
    fmt::print(
        "  about {} of a processor; a task needs {} of memory ({} for frames) and {} of "
        "$TMPDIR\n",
        short_duration(facts.cost_s), format_byte_size(grids.memory_bytes),
        format_byte_size(frames.memory_bytes), format_byte_size(grids.scratch_bytes));
    if (!plan.recipe().statistics) return;
    fmt::print("  statistics need {} of memory a task; all counts take at most {} on disk\n",
               format_byte_size(statistics.memory_bytes),
               format_byte_size(batch::bytes_of_counts(plan)));
}

// Checks the options for statistics, which count only reflectivity because their thresholds are in
// dBZ.
Status check_statistics(const PlanOptions& options, const Recipe& recipe) {
    if (!options.statistics && !options.cell_statistics) return {};
    const bool is_reflectivity = recipe.moments == std::vector{level2::Moment::ref};
    if (!options.mosaic.empty() && is_reflectivity) return {};
    return fail(ErrorCode::bad_argument,
                "statistics count the frames of --mosaic, and only of the moment REF");
}

int run_plan(const PlanOptions& options) {
    Recipe recipe;
    if (Status taken = take_places(options, recipe); !taken) return report_error(taken.error());
    const auto moments = parse_request(options.archive.place);
    if (!moments) return report_error(moments.error());
    recipe.moments = moments->moments();
    recipe.derived = moments->derived;
    if (Status good = check_statistics(options, recipe); !good) return report_error(good.error());
    const auto listing = take_stations(options, recipe);
    if (!listing) return report_error(listing.error());
    if (listing->nameless > 0) {
        print_note(fmt::format(
            "left out: {} {} whose names have no station and time, or cannot be in a plan, such "
            "as {}",
            listing->nameless, plural(listing->nameless, "file"), listing->first_nameless));
    }
    if (listing->links > 0) print_note(printable(links_text(*listing)));
    for (const std::string& cut : listing->cut)
        print_note(fmt::format("some of its volumes may be missing: {}", printable(cut)));
    if (Status written = batch::write_plan(options.output, recipe, listing->days); !written) {
        return report_error(written.error());
    }
    const auto plan = batch::Plan::open(options.output);
    if (!plan) return report_error(plan.error());
    print_facts(options, *plan);
    return exit_done;
}

}  // namespace

Run set_up_batch_plan(CLI::App& command) {
    const auto options = std::make_shared<PlanOptions>();
    options->archive.place.takes_moments = true;
    command
        .add_option("--source", options->source,
                    "Directory of the raw files, or of tars of them; or the address of a public "
                    "bucket, which must answer as Amazon S3 does")
        ->required();
    add_time_range(command, options->times);
    command
        .add_option("-o,--output", options->output,
                    "Directory of the plan, which all machines see under this path")
        ->required();
    command.add_option("--cache", options->cache,
                       "Directory of the grids, on a file system that all machines share. Default: "
                       "cache, in the plan's directory");
    command.add_option("--stations", options->archive.stations,
                       "ICAO identifiers of the stations, such as KBGM,KENX. Default: all whose "
                       "files the source has");
    command.add_option("--bounds", options->archive.bounds,
                       "The stations within these bounds, and with --mosaic its place: "
                       "WEST,SOUTH,EAST,NORTH in degrees");
    command
        .add_option("--moment", options->archive.place.moment,
                    "The moments to grid, separated by commas, or all")
        ->capture_default_str();
    add_derivation_options(command, options->archive.place);
    add_place_options(command, options->archive.place);
    command.add_option("--mosaic", options->mosaic,
                       "Also make frames of all stations together, under this name. Without it, "
                       "each station's own grids are made");
    command
        .add_option("--interval", options->interval,
                    "Time from frame to frame, as in 300, 90s, 5min or 1h")
        ->capture_default_str();
    command
        .add_option("--time-method", options->time_method,
                    fmt::format("How volumes are brought to a frame's time: {}",
                                names_in(grid::time_method_facts, ", ", " or ")))
        ->capture_default_str();
    add_overlap_options(command, options->archive, "");
    command.add_flag("--statistics", options->statistics,
                     "Also count the frames of --mosaic, by month and hour of the day, for a "
                     "climatology (batch statistics)");
    command.add_flag("--cell-statistics", options->cell_statistics,
                     "Like --statistics, and also count each cell, not only the greatest value of "
                     "each column. Memory and disk grow by the number of levels");
    command.add_flag("--json", options->json, "Print one JSON document");
    return [options] { return run_plan(*options); };
}

}  // namespace stormcellar::cli

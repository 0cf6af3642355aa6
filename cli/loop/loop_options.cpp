#include "cli/loop/loop_options.h"

#include <filesystem>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/name_list.h"

namespace stormcellar::cli {

void add_loop_options(CLI::App& loop, LoopOptions& options) {
    add_scene_file(loop, options.scene_file, options.scene, options.plan, &options);
    loop.add_option("--cache", options.cache,
                    "Directory of the cache. With --catalog, the grids are made there");
    loop.add_option("DOMAIN,--domain", options.domain,
                    "Domain of the grids; a station's own domain is its ICAO identifier. With "
                    "--catalog, the name of the mosaic");
    add_time_range(loop, options.range);
    loop.add_option(
        "--interval", options.interval,
        "Time from one frame to the next, such as 60, 90s or 5min. Frames between the grids are "
        "interpolated. Default: each grid is a frame; a mosaic from an archive has one every 5min");
    loop.add_option("--time-method", options.time_method,
                    fmt::format("How to interpolate between the grids: {} (the default)",
                                names_in(grid::time_method_facts, ", ", " or ")));
    loop.add_option(
            "-o,--output", options.outputs,
            fmt::format(
                "The output: {}. Give the option several times to write the same frames to each "
                "output. - writes WebP to standard output; -.gif and so on write another format",
                render::known_animation_endings()))
        ->required()
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    add_loop_settings(loop, options.scene, options);
    add_follow_options(loop, options.follow);
    loop.add_flag("--check", options.only_check, "Check the options, print what is wrong, and end")
        ->group("");  // not shown: for stormcellard --check-config
    loop.add_flag("--json", options.json,
                  "Print what was done as one JSON document; with --follow, one document per line");
    loop.add_flag("--quiet", options.quiet,
                  "Print only warnings and errors, no progress and no summary");
    add_archive_options(loop, options.archive);
    add_scene_options(loop, options.scene);
    add_picture_plan_options(loop, options.plan);
}

Result<Rhythm> rhythm_of(const LoopOptions& options) {
    Rhythm rhythm;
    if (!options.interval.empty()) {
        const auto interval = parse_interval("--interval", options.interval);
        if (!interval) return pass_on(interval);
        rhythm.interval = *interval;
    }
    if (options.time_method.empty()) return rhythm;
    if (!rhythm.interval && !options.archive.asked()) {
        return fail(ErrorCode::bad_argument, "--time-method needs --interval");
    }
    const auto method = grid::time_method_from_name(options.time_method);
    if (!method) {
        return fail(ErrorCode::bad_argument, "--time-method takes one of {}, not '{}'",
                    names_in(grid::time_method_facts, ", ", " and "), options.time_method);
    }
    rhythm.method = *method;
    return rhythm;
}

Status check_sources(const LoopOptions& options) {
    if (options.follow.wanted && (options.archive.asked() || !options.interval.empty())) {
        return fail(ErrorCode::bad_argument,
                    "--follow cannot be used with --catalog or --interval");
    }
    if (!options.archive.asked() && (options.cache.empty() || options.domain.empty())) {
        return fail(ErrorCode::bad_argument,
                    "a loop needs --cache and --domain, or --catalog and --stations");
    }
    return {};
}

Status check_outputs(const std::vector<std::string>& outputs) {
    std::set<std::filesystem::path> names;
    for (const std::string& output : outputs) {
        if (!names.insert(std::filesystem::path(output).lexically_normal()).second) {
            return fail(ErrorCode::bad_argument, "{}: this output is named twice", output);
        }
    }
    return {};
}

}  // namespace stormcellar::cli

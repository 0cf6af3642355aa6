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
                    "The cache's directory; with --catalog where the grids are to be made");
    loop.add_option("DOMAIN,--domain", options.domain,
                    "Whose grids; a station's is its ICAO. With --catalog a mosaic's name");
    add_time_range(loop, options.range);
    loop.add_option("--interval", options.interval,
                    "From frame to frame, e.g. 60, 90s, 5min: frames between the grids are made as "
                    "they are called for. Else each grid is a frame; of a mosaic from an archive "
                    "every 5min");
    loop.add_option(
        "--time-method", options.time_method,
        fmt::format("How: {} (the default)", names_in(grid::time_method_facts, ", ", " or ")));
    loop.add_option("-o,--output", options.outputs,
                    fmt::format("{}; several times: the same frames to each; - is standard output, "
                                "as WebP, -.gif and so on in another format",
                                render::known_animation_endings()))
        ->required()
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    add_loop_settings(loop, options.scene, options);
    add_follow_options(loop, options.follow);
    loop.add_flag("--check", options.only_check, "Say what is wrong with all this, and end")
        ->group("");  // not shown: for stormcellard --check-config
    loop.add_flag("--json", options.json,
                  "Say what was done as one JSON document; with --follow one a line");
    loop.add_flag("--quiet", options.quiet, "No progress and no summary; warnings and errors");
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
        return fail(ErrorCode::bad_argument, "--time-method goes with --interval");
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
        return fail(ErrorCode::bad_argument, "--follow goes with neither --catalog nor --interval");
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
            return fail(ErrorCode::bad_argument, "{}: named twice as an output", output);
        }
    }
    return {};
}

}  // namespace stormcellar::cli

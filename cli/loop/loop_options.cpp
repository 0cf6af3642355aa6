#include "cli/loop/loop_options.h"

#include <filesystem>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/name_list.h"
#include "cli/shared/cache_domain.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {

void add_loop_options(CLI::App& loop, LoopOptions& options) {
    add_scene_file(loop, options.scene_file, options.scene, options.plan, &options);
    loop.add_option("FILE", options.sources,
                    "Level II files to make a loop of, also of several sites, or a domain of the "
                    "cache. Tar and zip archives and directories work too. A word with a slash, or "
                    "one that names a file, is a file; every other word is a domain")
        ->option_text("FILE...|DOMAIN");
    loop.add_option("--domain", options.typed_domain,
                    "Domain of the grids; a station's own domain is its ICAO identifier. Default: "
                    "the only one of the cache. With files of several sites, or --catalog, it "
                    "names the mosaic");
    loop.add_option("--cache", options.cache_place.directory,
                    "Directory of the cache. With files or --catalog, the grids are made there. "
                    "Default: that of the service; with files or --catalog, a cache of your own");
    add_config_option(loop, options.cache_place.config);
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
        ->group("");  // hidden: for stormcellard --check-config
    loop.add_option("--panels", options.panels, "For frame alone")
        ->group("");  // hidden: refused with a message that names the option to use
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
    if (!rhythm.interval && !options.archive.asked() && options.files.empty()) {
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

Status take_sources(LoopOptions& options) {
    // With files or an archive, the domain is only a name for the mosaic, so do not look for it in
    // a cache.
    auto names = tell_apart_from_cache(options.sources, {}, options.cache_place);
    if (!names) return pass_on(names);
    options.files = std::move(names->files);
    if (!names->domain.empty() && !options.typed_domain.empty()) {
        return fail(ErrorCode::bad_argument, "there are two domains, '{}' and '{}'; name one",
                    options.typed_domain, names->domain);
    }
    for (const std::string& typed : {options.typed_domain, names->domain}) {
        if (!typed.empty()) options.domain = typed;
    }
    // The scene file may name a domain of the cache. With files, ignore that domain.
    if (!options.files.empty()) options.domain = options.typed_domain;
    if (!options.files.empty() || options.archive.asked()) {
        options.cache = options.cache_place.directory;
        return {};
    }
    if (Status found = options.cache_place.find(); !found) {
        if (options.sources.empty()) return found;
        return fail(ErrorCode::bad_argument,
                    "'{}' names no file here, and there is no cache to look for such a domain; {}",
                    options.domain, found.error().message);
    }
    options.cache = options.cache_place.directory;
    if (!options.domain.empty()) return {};
    const auto store = cache::StoreReader::open(options.cache);
    return store ? take_only_domain(*store, options.domain) : pass_on(store);
}

Status check_sources(const LoopOptions& options) {
    const bool made = options.archive.asked() || !options.files.empty();
    if (options.follow.wanted && (made || !options.interval.empty())) {
        return fail(ErrorCode::bad_argument,
                    "--follow is for a domain of the cache; it cannot be used with files, "
                    "--catalog or --interval");
    }
    if (options.archive.asked() && !options.files.empty()) {
        return fail(ErrorCode::bad_argument, "a loop is of files or of a --catalog; name only one");
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

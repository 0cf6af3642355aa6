// stormcellar loop: makes an animation of the grids of a time range.
#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/steady_time.h"
#include "cli/loop/files_loop.h"
#include "cli/loop/loop_camera.h"
#include "cli/loop/loop_draw.h"
#include "cli/loop/loop_encoding.h"
#include "cli/loop/loop_grids.h"
#include "cli/loop/loop_options.h"
#include "cli/loop/loop_report.h"
#include "cli/loop/sweep_loop.h"
#include "cli/picture/drawn_frames.h"
#include "cli/picture/picture.h"
#include "cli/picture/picture_plan.h"
#include "cli/shared/commands.h"
#include "cli/shared/follow.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output_file.h"
#include "cli/shared/progress.h"
#include "render/frame/overlay_text.h"
#include "render/frame/picture_metadata.h"
#include "render/options/picture_options.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::cli {
namespace {

Status draw_all(LoopGrids& grids, const LoopOptions& options, const LoopScene& shown,
                const std::atomic<bool>& stop, Encoding& encoding, LoopReport& report) {
    const std::vector<LoopFrame>& frames = grids.frames;
    Progress progress("frames", frames.size(), !options.quiet);
    const auto cameras = cameras_of(options, shown, grids.frames_there, frames.size());
    if (!cameras) return pass_on(cameras);
    auto shapes = render::read_shapes(options.scene);
    if (!shapes) return pass_on(shapes);
    Drawing drawing;
    drawing.scene = shown.scene;
    drawing.shapes = std::move(*shapes);
    drawing.store = grids.store;
    if (render::marks_cells(options.scene)) {
        drawing.cells.emplace(*grids.store, grids.domain,
                              chosen_freezing_levels(options.scene, shown.scene));
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (stop) return {};
        drawing.scene.camera = (*cameras)[i];
        auto picture = draw(frames[i], options, grids.between, drawing, report);
        if (!picture) return pass_on(picture);
        if (*picture) {
            if (auto added = encoding.add(std::move(**picture)); !added) return added;
        } else {
            progress.clear();
            warn_skipped(report.skipped.back());
        }
        progress.show(i + 1);
    }
    return {};
}

// Draws and writes the loop; adds to `report`.
Status make_loop(LoopGrids& grids, const LoopOptions& options, const LoopScene& scene,
                 const std::atomic<bool>& stop, LoopReport& report) {
    auto writers = make_writers(options.outputs, options.animation);
    if (!writers) return pass_on(writers);
    Encoding encoding(std::move(*writers));
    if (auto drawn = draw_all(grids, options, scene, stop, encoding, report); !drawn) return drawn;
    if (!stop) {
        if (report.frames == 0) {
            const std::size_t count = report.skipped.size();
            return fail(ErrorCode::corrupt, "{}: {} be read; nothing was written",
                        grids.store->directory().native(),
                        count == 1 ? std::string{"the only grid cannot"}
                                   : fmt::format("none of the {} grids can", count));
        }
        if (auto finished = encoding.finish(stop); !finished) return finished;
        report.encode_s = encoding.encode_s();
    }
    report.interrupted = stop;
    return {};
}

// Reports and removes the grids that cannot be opened, so that the loop's description states the
// true number of frames. Returns the first grid that can be opened. The plan for this grid is used
// for all frames, and the report names the method of this plan.
std::optional<cache::GridFile> keep_readable(LoopGrids& grids, LoopReport& report) {
    std::optional<cache::GridFile> first;
    bool is_mixed = false;
    const auto look_at = [&](const std::filesystem::path& path) {
        auto file = cache::GridFile::open(path);
        if (!file) {
            report.skipped.push_back({path, file.error().message});
            warn_skipped(report.skipped.back());
        } else if (!first) {
            first.emplace(std::move(*file));
        } else {
            is_mixed = is_mixed || file->description().spec != first->description().spec;
        }
        return file.has_value();
    };
    std::erase_if(grids.frames, [&](const LoopFrame& frame) {
        return frame.stored && !look_at(frame.stored->path);
    });
    if (!first && !grids.frames.empty()) look_at(grids.sample);
    if (is_mixed) {
        print_note(
            "grids of this domain differ in place or size, so the view differs between frames");
    }
    return first;
}

// Fits the view to the echo of all grids. If grids are made only when their frames are drawn, fits
// the view to the first grid alone.
Status fit_loop(const LoopGrids& grids, const cache::GridFile& first, const LoopOptions& options,
                LoopScene& shown) {
    render::Scene& scene = shown.scene;
    render::EchoOutline outline(first.view(), scene.moment);
    const bool fits = render::fits_anything(options.scene);
    for (const LoopFrame& frame : grids.frames) {
        if (!fits || !frame.stored) continue;
        const auto file = cache::GridFile::open(frame.stored->path);
        if (file) outline.add(file->view(), scene.moment);
    }
    const auto facts = frame_facts_of(options.domain, first.description(), options.scene.time_zone);
    const auto fitted = render::fit_picture(outline, first.view(), facts, options.scene, scene,
                                            moves_camera(options), options.kept_view);
    if (!fitted) return pass_on(fitted);
    shown.view = *fitted;
    return {};
}

// Plans how to draw the first grid, and writes the description of the loop into the metadata.
Status prepare(const LoopGrids& grids, const cache::GridFile& first, LoopOptions& options,
               render::Scene& scene) {
    const auto& description = first.description();
    const auto facts = frame_facts_of(options.domain, description, options.scene.time_zone);
    const auto error = plan_picture(first.view(), facts, options.plan, options.json,
                                    render::thread_count(options.scene), scene);
    if (!error) return pass_on(error);
    const bool some_between =
        std::any_of(grids.frames.begin(), grids.frames.end(),
                    [](const LoopFrame& frame) { return !frame.stored.has_value(); });
    const std::string between = some_between ? grids.between->method_text() : "";
    const auto by_time = [](const LoopFrame& a, const LoopFrame& b) { return a.time < b.time; };
    const auto [from, to] = std::minmax_element(grids.frames.begin(), grids.frames.end(), by_time);
    render::PictureFacts told{options.domain,      from->time, to->time,
                              grids.frames.size(), between,    *error};
    if (render::marks_cells(options.scene))
        told.cells = render::cells_method(chosen_freezing_levels(options.scene, scene));
    told.shapes = render::shape_names(options.scene);
    options.animation.metadata = render::metadata_of(told, description, scene);
    return {};
}

// Distributes the grids over the frames of the loop. A followed loop (--follow) may begin with a
// single grid; its camera then does not move until there are more grids.
Status spread(LoopGrids& grids, const LoopOptions& options) {
    auto& frames = grids.frames;
    grids.frames_there = frames.size();
    if (frames.empty()) return {};
    const auto count = frame_count(options, frames.size());
    if (!count) return options.follow.wanted ? Status{} : pass_on(count);
    std::vector<LoopFrame> all;
    for (std::size_t i = 0; i < *count; ++i)
        all.push_back(frames[i * frames.size() / *count]);
    frames = std::move(all);
    grids.frames_there = frames.size();
    return {};
}

// Appends the frames in reverse order, without the first and the last.
void turn_back(std::vector<LoopFrame>& frames) {
    for (std::size_t i = frames.size(); i > 2; --i) {
        const LoopFrame frame = frames[i - 2];
        frames.push_back(frame);
    }
}

// Draws the loop and returns the exit status. An interrupt of a followed loop is not a failure.
int draw_loop(LoopGrids grids, LoopOptions options, render::Scene scene, Interrupt& interrupt,
              SteadyTime start) {
    options.domain = grids.domain;
    auto& frames = grids.frames;
    if (options.last > 0 && std::cmp_greater(frames.size(), options.last)) {
        frames.erase(frames.begin(), frames.end() - options.last);
    }
    LoopScene shown{std::move(scene), {}};
    LoopReport report;
    const auto first = keep_readable(grids, report);
    shown.view.camera = shown.scene.camera;
    if (first) {
        if (auto fitted = fit_loop(grids, *first, options, shown); !fitted) {
            return report_error(fitted.error());
        }
    }
    if (auto fine = spread(grids, options); !fine) return report_error(fine.error());
    if (options.ping_pong) turn_back(frames);
    if (first) {
        if (auto prepared = prepare(grids, *first, options, shown.scene); !prepared) {
            return report_error(prepared.error());
        }
    }
    if (auto made = make_loop(grids, options, shown, interrupt.flag(), report); !made) {
        return report_error(made.error());
    }
    report.total_s = seconds_since(start);
    if (report.interrupted) {
        if (options.follow.wanted) return exit_done;
        fmt::print(stderr, "stormcellar: interrupted; unfinished loops were not written\n");
        interrupt.end_by_signal();
        return exit_failed;
    }
    if (grids.archive) {
        if (auto left = leave_cache(*grids.call, *grids.archive); !left) {
            return report_error(left.error());
        }
        if (auto left = leave_files(options); !left) return report_error(left.error());
    }
    print_report(options, shown.scene, report, grids.archive);
    return exit_done;
}

// Opens the cache. Returns none if the cache does not exist yet.
Result<std::optional<cache::StoreReader>> open_if_there(const std::string& cache) {
    auto opened = cache::StoreReader::open(cache);
    if (opened) return std::optional{std::move(*opened)};
    if (opened.error().code != ErrorCode::not_found) return pass_on(opened);
    return std::optional<cache::StoreReader>{};
}

// Returns the grids that exist now. Opens a cache that has appeared in the meantime.
Result<std::vector<cache::StoreEntry>> entries_of(std::optional<cache::StoreReader>& store,
                                                  const LoopOptions& options,
                                                  level2::Moment moment) {
    if (const auto range = parse_time_range(options.range); !range) return pass_on(range);
    if (!store) {
        auto opened = open_if_there(options.cache);
        if (!opened) return pass_on(opened);
        store = std::move(*opened);
    }
    if (!store) return std::vector<cache::StoreEntry>{};
    return entries_now(*store, options, moment);
}

// Makes the loop again after each change of the cache, from the grids that exist then.
int follow_loop(LoopOptions options, const render::Scene& scene, Interrupt& interrupt) {
    auto opened = open_if_there(options.cache);
    if (!opened) return report_error(opened.error());
    std::optional<cache::StoreReader> store = std::move(*opened);
    DrawnFrames kept;
    options.kept = &kept;
    std::optional<render::FittedView> kept_view;
    options.kept_view = &kept_view;
    return follow({options.cache, options.domain, scene.moment,
                   [&] { return entries_of(store, options, scene.moment); },
                   [&](const auto& entries) {
                       kept.next_loop();
                       return draw_loop(grids_of(*store, options.domain, entries), options, scene,
                                        interrupt, steady_now());
                   },
                   options.quiet},
                  options.follow, interrupt.flag());
}

// Applies the camera path of the scene file. Ignores the path if options say where the camera is or
// how it moves. With the path, the camera begins at the path's first key.
void take_camera_keys(LoopOptions& options) {
    if (options.camera.empty()) return;
    if (std::ranges::any_of(options.scene.typed,
                            [](const PictureOption* row) { return moves_camera(*row); })) {
        options.camera.clear();
        return;
    }
    render::Camera& camera = options.scene.scene.camera;
    if (options.camera.front().eye) camera.eye = options.camera.front().eye;
    if (options.camera.front().look_at) camera.look_at = options.camera.front().look_at;
}

// Refuses panels if they were typed. If a moment was typed, ignores the panels of a scene file.
Status refuse_panels(const LoopOptions& options) {
    const bool is_one = render::contains(options.scene.typed, render::moment_option());
    const bool are_in_file = !options.scene.panels.empty() && !is_one;
    if (options.panels.empty() && !are_in_file) return {};
    return fail(ErrorCode::bad_argument,
                "{} is for frame, which draws several moments side by side; a loop shows one "
                "moment, so name it with --moment",
                options.panels.empty() ? options.scene_file.path + ": [picture] panels"
                                       : std::string{"--panels"});
}

// Refuses products that only `frame` draws.
Status check_sums(const render::Scene& scene) {
    if (!render::facts_of(scene.product).is_sum) return {};
    return fail(ErrorCode::bad_argument, "{} is for frame, which adds up several files",
                render::product_name(scene.product));
}

// Refuses options that a loop of sweeps does not support.
Status check_sweeps(const LoopOptions& options, const render::Scene& scene) {
    if (!render::facts_of(scene.product).is_of_sweep) return {};
    if (options.follow.wanted) {
        return fail(ErrorCode::bad_argument,
                    "--follow waits for grids, and a ppi is drawn from raw files; leave it out");
    }
    const bool names_one = scene.sweep_number != render::Scene::no_number ||
                           scene.elevation_deg != render::Scene::lowest_sweep;
    if (options.all_elevations && names_one) {
        return fail(ErrorCode::bad_argument,
                    "--all-elevations shows all sweeps; leave out --elevation and --sweep");
    }
    if (options.repeats &&
        (options.all_elevations || scene.sweep_number != render::Scene::no_number)) {
        return fail(ErrorCode::bad_argument,
                    "--repeats shows the sweeps of one elevation; leave out --all-elevations "
                    "and --sweep");
    }
    return {};
}

// Makes all checks that are possible without a grid, and resolves options that depend on each
// other.
Result<render::Scene> check(LoopOptions& options) {
    if (options.scene_file.error) return tl::unexpected(*options.scene_file.error);
    if (auto fine = check_outputs(options.outputs); !fine) return pass_on(fine);
    if (auto fine = refuse_panels(options); !fine) return pass_on(fine);
    take_camera_keys(options);
    auto scene = scene_with(options.scene_file, options.scene);
    if (!scene) return scene;
    auto plan = plan_beside_slices(options.plan, options.scene);
    if (!plan) return pass_on(plan);
    options.plan = std::move(*plan);
    // With --check, do not look at the cache, because it may not exist yet.
    const bool has_source = !options.domain.empty() || !options.typed_domain.empty() ||
                            !options.sources.empty() || options.archive.asked();
    if (options.only_check && !has_source) {
        return fail(ErrorCode::bad_argument, "a loop that is kept needs a domain: --domain");
    }
    if (auto taken = take_sources(options); !taken) return pass_on(taken);
    if (auto fine = check_sources(options); !fine) return pass_on(fine);
    if (auto fine = check_sums(*scene); !fine) return pass_on(fine);
    if (auto fine = check_sweeps(options, *scene); !fine) return pass_on(fine);
    const bool makes_grids = options.archive.asked() || !options.files.empty();
    if (makes_grids) return scene;
    if (auto fine = render::check_stored_derivation(options.scene, scene->product); !fine)
        return pass_on(fine);
    return scene;
}

// Checks the options only. Writes nothing, and needs no directory to exist.
int only_check(const LoopOptions& options) {
    for (const std::string& output : options.outputs) {
        if (auto fine = render::check_animation_name(output); !fine) {
            return report_error(fine.error());
        }
    }
    const auto range = parse_time_range(options.range);
    return range ? exit_done : report_error(range.error());
}

// If an output is standard output, returns a temporary file for it, else none. Standard output is
// "-" (WebP), or "-.gif" and so on for another format.
Result<std::optional<OutputFile>> take_stdout(LoopOptions& options) {
    const auto is_piped = [](const std::string& output) {
        return is_stdout(output) || output.starts_with("-.");
    };
    const auto piped = std::ranges::find_if(options.outputs, is_piped);
    if (piped == options.outputs.end()) return std::optional<OutputFile>{};
    if (options.json || options.follow.wanted ||
        std::ranges::count_if(options.outputs, is_piped) > 1) {
        return fail(ErrorCode::bad_argument,
                    "-o {}: standard output takes only one loop, without --json and --follow",
                    *piped);
    }
    auto file = OutputFile::open("-", is_stdout(*piped) ? ".webp" : piped->substr(1));
    if (!file) return pass_on(file);
    *piped = options.piped = file->path().native();
    return std::optional{std::move(*file)};
}

// Copies a finished loop to standard output if an output is standard output.
int finish_piped(int status, std::optional<OutputFile>& piped) {
    if (status != exit_done || !piped) return status;
    const Status written = piped->finish();
    return written ? exit_done : report_error(written.error());
}

int run_loop(LoopOptions options) {
    const auto start = steady_now();
    auto piped = take_stdout(options);
    if (!piped) return report_error(piped.error());
    const auto scene = check(options);
    if (!scene) return report_error(scene.error());
    if (options.only_check) return only_check(options);
    // Refuse an output that can never be written before any grid is made.
    if (const auto writers = make_writers(options.outputs, options.animation); !writers) {
        return report_error(writers.error());
    }
    Interrupt interrupt;
    if (options.follow.wanted) return follow_loop(options, *scene, interrupt);
    if (render::facts_of(scene->product).is_of_sweep) {
        return finish_piped(run_sweep_loop(options, *scene, interrupt, start), *piped);
    }
    if (!options.files.empty()) {
        if (auto made = catalog_files(options, interrupt); !made) return report_error(made.error());
    }
    auto grids = find_grids(options, *scene, interrupt);
    if (!grids) return report_error(grids.error());
    if (grids->frames.empty()) return exit_nothing_matched;
    return finish_piped(draw_loop(std::move(*grids), options, *scene, interrupt, start), *piped);
}

}  // namespace

Run set_up_loop(CLI::App& loop) {
    const auto options = std::make_shared<LoopOptions>();
    add_loop_options(loop, *options);
    return [options] { return run_loop(*options); };
}

}  // namespace stormcellar::cli

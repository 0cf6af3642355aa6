// stormcellar loop: the grids of a time range as animations.
#include <atomic>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cache/grid_file.h"
#include "cache/store.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/loop_encoding.h"
#include "cli/loop_grids.h"
#include "cli/loop_options.h"
#include "cli/loop_report.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "render/map/map_layer.h"

namespace stormcellar::cli {
namespace {

// What the frames of a loop share; how exactly they are drawn is planned for the first.
struct Drawing {
    render::Scene scene;
    render::MapKeeper map;
    bool is_planned = false;
};

// One frame; none when the grid's file is damaged, which is noted.
Result<std::optional<render::Image>> draw(const cache::StoreEntry& entry,
                                          const LoopOptions& options, Drawing& drawing,
                                          LoopReport& report) {
    const auto start = Clock::now();
    const auto file = cache::GridFile::open(entry.path);
    report.read_s += seconds_since(start);
    if (!file) {
        report.skipped.push_back({entry.path, file.error().message});
        return std::optional<render::Image>{};
    }
    const auto opened = Clock::now();
    const auto facts = facts_of(options.domain, file->description(), options.scene.time_zone);
    const int threads = thread_count(options.scene);
    if (!drawing.is_planned) {
        if (auto planned = plan_picture(file->view(), facts, options.plan, options.json, threads,
                                        drawing.scene);
            !planned) {
            return pass_on(planned);
        }
        drawing.is_planned = true;
    }
    auto picture = render::render_frame(file->view(), facts, drawing.scene, threads, &drawing.map);
    report.render_s += seconds_since(opened);
    if (!picture) return pass_on(picture);
    if (const Status whole = file->check_whole(); !whole) {  // cut while it was drawn
        report.skipped.push_back({entry.path, whole.error().message});
        return std::optional<render::Image>{};
    }
    if (report.frames == 0) report.from = report.to = entry.time;
    report.to = std::max(report.to, entry.time);
    ++report.frames;
    return std::optional{std::move(*picture)};
}

Status draw_all(const std::vector<cache::StoreEntry>& entries, const LoopOptions& options,
                const render::Scene& scene, const std::atomic<bool>& stop, Encoding& encoding,
                LoopReport& report) {
    Progress progress("frames", entries.size(), !options.quiet);
    Drawing drawing{scene, {}};
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (stop) return {};
        drawing.scene.camera.azimuth_deg =
            scene.camera.azimuth_deg +
            options.orbit_deg * static_cast<double>(i) / static_cast<double>(entries.size());
        auto picture = draw(entries[i], options, drawing, report);
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

Result<LoopReport> make_loop(const std::vector<cache::StoreEntry>& entries,
                             const LoopOptions& options, const render::Scene& scene,
                             const std::atomic<bool>& stop, Clock::time_point start) {
    auto writers = make_writers(options.outputs, options.animation);
    if (!writers) return pass_on(writers);
    Encoding encoding(std::move(*writers));
    LoopReport report;
    if (auto drawn = draw_all(entries, options, scene, stop, encoding, report); !drawn) {
        return pass_on(drawn);
    }
    if (!stop) {
        if (report.frames == 0) {
            return fail(ErrorCode::corrupt, "{}: each of the {} grids is damaged; nothing written",
                        options.cache, entries.size());
        }
        if (auto finished = encoding.finish(stop); !finished) return pass_on(finished);
        report.encode_s = encoding.encode_s();
    }
    report.interrupted = stop;
    report.total_s = seconds_since(start);
    return report;
}

// Adds the way back, without the two ends.
void turn_back(std::vector<cache::StoreEntry>& entries) {
    for (std::size_t i = entries.size(); i > 2; --i) {
        const cache::StoreEntry entry = entries[i - 2];
        entries.push_back(entry);
    }
}

int run_loop(LoopOptions options) {
    const auto start = Clock::now();
    if (auto fine = check_outputs(options.outputs); !fine) return report_error(fine.error());
    const auto scene = scene_of(options.scene);
    if (!scene) return report_error(scene.error());
    Interrupt interrupt;
    auto grids = find_grids(options, *scene, interrupt);
    if (!grids) return report_error(grids.error());
    if (grids->entries.empty()) return exit_nothing_matched;
    options.domain = grids->domain;
    auto& entries = grids->entries;
    if (options.last > 0 && entries.size() > options.last) {
        entries.erase(entries.begin(), entries.end() - static_cast<std::ptrdiff_t>(options.last));
    }
    options.animation.metadata = metadata_of(entries, options, *scene);
    if (options.ping_pong) turn_back(entries);

    const auto report = make_loop(entries, options, *scene, interrupt.flag(), start);
    if (!report) return report_error(report.error());
    if (report->interrupted) {
        fmt::print(stderr, "stormcellar: interrupted; unfinished loops were not written\n");
        interrupt.end_by_signal();
        return exit_failed;
    }
    if (grids->archive) {
        if (auto left = leave_cache(*grids->call, *grids->archive); !left) {
            return report_error(left.error());
        }
    }
    print_report(options, *scene, *report, grids->archive);
    return exit_done;
}

}  // namespace

Command add_loop(CLI::App& app) {
    const auto options = std::make_shared<LoopOptions>();
    CLI::App* loop =
        app.add_subcommand("loop", "Draw the grids of a time range as a looping animation");
    loop->footer(
        "A grid file that is damaged is named on stderr and left out; the exit status is 0 when "
        "at least one frame was written.\n");
    add_loop_options(*loop, *options);
    return {loop, [options] { return run_loop(*options); }};
}

}  // namespace stormcellar::cli

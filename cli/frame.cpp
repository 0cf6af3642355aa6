// stormcellar frame: one still picture of a grid in the cache.
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/file_system.h"
#include "base/version.h"
#include "cache/store.h"
#include "cli/commands.h"
#include "cli/picture.h"
#include "cli/scene_options.h"
#include "render/png_file.h"

namespace stormcellar::cli {
namespace {

struct FrameOptions {
    std::string cache;
    std::string domain;
    std::string time;  // empty: the latest
    std::string output;
    bool json = false;
    SceneOptions scene;
};

// The newest grid of the domain at or before the time; none when there is no such grid.
Result<std::optional<cache::StoreEntry>> find_grid(const cache::Store& store,
                                                   const FrameOptions& options) {
    std::optional<UtcTime> until;
    if (!options.time.empty()) {
        const auto time = parse_utc(options.time, now_utc());
        if (!time) return pass_on(time);
        until = *time;
    }
    const auto entries = store.list(options.domain, level2::Moment::ref, std::nullopt, until);
    if (!entries) return pass_on(entries);
    if (entries->empty()) return std::optional<cache::StoreEntry>{};
    return std::optional{entries->back()};
}

int report_nothing(const cache::Store& store, const FrameOptions& options) {
    return report_no_grid(
        store, options.domain,
        options.time.empty() ? std::string{} : fmt::format(" at or before {}", options.time));
}

std::vector<std::pair<std::string, std::string>> texts_of(const cache::GridDescription& grid,
                                                          const FrameOptions& options) {
    return {{"Title", fmt::format("{} {}", options.domain, format_utc(grid.time))},
            {"Description", ascii(fmt::format("reflectivity, {}; gridded by {}, {}; from {}",
                                              options.scene.product, grid.provenance.method,
                                              grid.provenance.beam_model,
                                              fmt::join(grid.provenance.source_files, " ")))},
            {"Software", fmt::format("stormcellar {}", software_version)}};
}

struct Timing {
    double read_s = 0, render_s = 0, write_s = 0, total_s = 0;
};

void report_frame(const FrameOptions& options, const render::Scene& scene,
                  const cache::GridDescription& grid, const Timing& timing) {
    if (!options.json) {
        fmt::print(stderr, "{}: {} {}, {}, {} x {} pixels, {:.0f} ms\n", printable(options.output),
                   printable(options.domain), format_utc(grid.time), options.scene.product,
                   scene.width, scene.height, timing.total_s * 1e3);
        return;
    }
    const nlohmann::ordered_json json{{"output", options.output},
                                      {"domain", options.domain},
                                      {"time", format_utc(grid.time)},
                                      {"product", options.scene.product},
                                      {"width", scene.width},
                                      {"height", scene.height},
                                      {"partial", grid.provenance.partial},
                                      {"read_s", timing.read_s},
                                      {"render_s", timing.render_s},
                                      {"write_s", timing.write_s},
                                      {"total_s", timing.total_s}};
    fmt::print("{}\n", json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

Result<Timing> make_frame(const FrameOptions& options, const render::Scene& scene,
                          const cache::GridFile& file, Clock::time_point start) {
    Timing timing;
    timing.read_s = seconds_since(start);
    const auto picture =
        render::render_frame(file.view(), facts_of(options.domain, file.description()), scene,
                             thread_count(options.scene));
    if (!picture) return pass_on(picture);
    if (Status whole = file.check_whole(); !whole) return pass_on(whole);
    timing.render_s = seconds_since(start) - timing.read_s;
    const auto bytes = render::encode_png(*picture, texts_of(file.description(), options));
    if (!bytes) return pass_on(bytes);
    if (auto written = write_file_atomically(real_file_system(), options.output, *bytes);
        !written) {
        return pass_on(written);
    }
    timing.total_s = seconds_since(start);
    timing.write_s = timing.total_s - timing.read_s - timing.render_s;
    return timing;
}

int run_frame(const FrameOptions& options) {
    const auto start = Clock::now();
    if (!options.output.ends_with(".png")) {
        return report_error({ErrorCode::bad_argument,
                             fmt::format("{}: a frame is written as .png", options.output)});
    }
    if (const Status writable = check_target(options.output); !writable) {
        return report_error(writable.error());
    }
    const auto scene = scene_of(options.scene);
    if (!scene) return report_error(scene.error());
    const auto store = cache::Store::open_for_reading(options.cache);
    if (!store) return report_error(store.error());
    const auto entry = find_grid(*store, options);
    if (!entry) return report_error(entry.error());
    if (!*entry) return report_nothing(*store, options);
    const auto file = cache::GridFile::open((*entry)->path);
    if (!file) return report_error(file.error());
    const auto timing = make_frame(options, *scene, *file, start);
    if (!timing) return report_error(timing.error());
    report_frame(options, *scene, file->description(), *timing);
    return exit_done;
}

}  // namespace

Command add_frame(CLI::App& app) {
    const auto options = std::make_shared<FrameOptions>();
    CLI::App* frame = app.add_subcommand("frame", "Draw one still picture of a grid in the cache");
    frame->add_option("--cache", options->cache, "The cache's directory")->required();
    frame->add_option("DOMAIN,--domain", options->domain, "Whose grids; a station's is its ICAO")
        ->required();
    frame->add_option("--time", options->time,
                      "UTC, or relative as -1h: the grid at or next before it (default: latest)");
    frame->add_option("-o,--output", options->output, "The picture, .png")->required();
    frame->add_flag("--json", options->json, "Say what was done as one JSON document");
    add_scene_options(*frame, options->scene);
    return {frame, [options] { return run_frame(*options); }};
}

}  // namespace stormcellar::cli

// stormcellar synth SCENE.toml -o DIR: writes the Level II files of a simulated scene.
#include <algorithm>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/steady_time.h"
#include "cli/shared/commands.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/progress.h"
#include "cli/shared/query_options.h"
#include "synth/write_scene.h"

namespace stormcellar::cli {
namespace {

struct SynthOptions {
    std::string scene;
    std::string directory;
    int threads = 0;  // 0: as many as the machine has
    bool json = false;
};

void print_report(const synth::WrittenScene& written, double total_s, bool as_json) {
    if (!as_json) {
        for (const auto& file : written.files) {
            fmt::print("{}\n", printable(file.native()));
        }
        return;
    }
    auto files = nlohmann::ordered_json::array();
    for (const auto& file : written.files) {
        files.push_back(file.native());
    }
    print_json({{"files", files}, {"bytes", written.bytes}, {"total_s", total_s}});
}

int run_synth(const SynthOptions& options) {
    const auto start = steady_now();
    const auto scene = synth::read_scene(options.scene);
    if (!scene) return report_error(scene.error());
    Interrupt interrupt;
    const auto count = static_cast<std::size_t>(scene->schedule.count);
    std::size_t done = 0;
    Progress progress("volumes", count, !options.json);
    synth::WriteSceneOptions write_options;
    write_options.stop = &interrupt.flag();
    write_options.written = [&](const std::filesystem::path&) { progress.show(++done); };
    write_options.threads =
        options.threads > 0 ? options.threads
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const auto written =
        synth::write_scene(*scene, options.directory, real_file_system(), write_options);
    progress.clear();
    if (!written) return report_error(written.error());
    print_report(*written, seconds_since(start), options.json);
    if (!written->stopped) return exit_done;
    fmt::print(stderr, "stormcellar: interrupted after {} of {} {}\n", written->files.size(), count,
               plural(static_cast<std::uint64_t>(count), "volume"));
    interrupt.end_by_signal();
    return exit_failed;
}

}  // namespace

Run set_up_synth(CLI::App& synth) {
    const auto options = std::make_shared<SynthOptions>();
    synth.add_option("SCENE", options->scene, "The file of the scene, in TOML (docs/scenes.md)")
        ->required();
    synth
        .add_option("-o,--output", options->directory,
                    "Directory for the files; existing files of the same names are replaced")
        ->required();
    synth
        .add_option("--threads", options->threads,
                    "Number of volumes to write at a time. Default: all processors")
        ->check(CLI::Range(1, 256));
    synth.add_flag("--json", options->json, "Print what was done as one JSON document");
    return [options] { return run_synth(*options); };
}

}  // namespace stormcellar::cli

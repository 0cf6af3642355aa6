// stormcellar replay SOURCE... DROP: play files into a drop directory as LDM would.
#include "synth/replay.h"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "cli/query_options.h"

namespace stormcellar::cli {
namespace {

struct ReplayCommandOptions {
    std::vector<std::string> places;  // sources, and the drop directory as the last
    std::string delivery = "whole";
    std::optional<double> interval_s;
    double speed = 1;
    bool json = false;
};

int report_stop(const synth::ReplayReport& report, std::size_t items, Interrupt& interrupt) {
    fmt::print(stderr, "stormcellar: interrupted after {} of {} {}\n", report.files, items,
               plural(items, "file"));
    if (!report.unfinished.empty()) {
        fmt::print(stderr, "stormcellar: {} stays unfinished\n",
                   printable(report.unfinished.native()));
    }
    interrupt.end_by_signal();
    return exit_failed;
}

int run_replay(const ReplayCommandOptions& options) {
    const auto start = Clock::now();
    const std::vector<std::filesystem::path> sources(options.places.begin(),
                                                     options.places.end() - 1);
    const auto items = synth::find_replay_items(sources);
    if (!items) return report_error(items.error());
    Interrupt interrupt;
    Progress progress("files", items->size(), !options.json);
    synth::ReplayOptions replay_options;
    replay_options.delivery =
        options.delivery == "growing" ? synth::Delivery::growing : synth::Delivery::whole;
    replay_options.interval_s = options.interval_s;
    replay_options.speed = options.speed;
    replay_options.stop = &interrupt.flag();
    replay_options.replayed = [&](std::size_t done) { progress.show(done); };
    const auto report =
        synth::replay(*items, options.places.back(), real_file_system(), replay_options);
    progress.clear();
    if (!report) return report_error(report.error());
    if (report->stopped) return report_stop(*report, items->size(), interrupt);
    const double total_s = seconds_since(start);
    if (options.json) {
        print_json({{"files", report->files}, {"bytes", report->bytes}, {"total_s", total_s}});
    } else {
        fmt::print(stderr, "{} {}, {} bytes, {:.1f} s\n", report->files,
                   plural(report->files, "file"), report->bytes, total_s);
    }
    return exit_done;
}

}  // namespace

Command add_replay(CLI::App& app) {
    const auto options = std::make_shared<ReplayCommandOptions>();
    CLI::App* replay = app.add_subcommand(
        "replay", "Play files into a drop directory as LDM would, in the order of their times");
    replay
        ->add_option("PLACES", options->places,
                     "Files or directories to play, and the drop directory as the last")
        ->required()
        ->expected(2, 1'000'000)
        ->option_text("SOURCE... DROP");
    replay
        ->add_option("--as", options->delivery,
                     "Whole: renamed when complete; growing: appended and closed again and again")
        ->check(CLI::IsMember({"whole", "growing"}))
        ->option_text("whole|growing");
    auto* interval = replay->add_option("--interval", options->interval_s,
                                        "Seconds from file to file, whatever their times");
    interval->check(CLI::Range(0.0, 86400.0));
    replay
        ->add_option("--speed", options->speed,
                     "How many times faster than the files' own times (default: 1)")
        ->check(CLI::Range(0.001, 1e6))
        ->excludes(interval);
    replay->add_flag("--json", options->json, "Say what was done as one JSON document");
    return {replay, [options] { return run_replay(*options); }};
}

}  // namespace stormcellar::cli

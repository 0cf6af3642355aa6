// stormcellar replay SOURCE... DROP: writes files into a drop directory as LDM would.
#include "synth/replay.h"

#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/steady_time.h"
#include "cli/shared/commands.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/progress.h"
#include "cli/shared/query_options.h"
#include "cli/shared/short_duration.h"

namespace stormcellar::cli {
namespace {

constexpr double worth_a_hint_s = 600;

struct ReplayCommandOptions {
    std::vector<std::string> places;  // the sources, then the drop directory
    std::string delivery = "whole";
    std::optional<double> interval_s;
    double speed = 1;
    std::string faults;
    bool json = false;
};

// Returns the duration as text, such as "4.5 d" or "no time".
std::string duration_of(double seconds) {
    return seconds < 0.001 ? "no time" : short_duration(seconds);
}

void say_plan(const synth::ReplayPlan& plan) {
    std::string times;
    if (plan.first)
        times = fmt::format(" of {} to {}", format_utc(*plan.first), format_utc(*plan.last));
    fmt::print(stderr, "stormcellar: {}{}; the replay takes {}{}\n", counted(plan.files, "file"),
               times, duration_of(plan.takes_s),
               plan.takes_s > worth_a_hint_s ? " (--speed N makes it faster; --interval S sends a "
                                               "file every S seconds, whatever their times)"
                                             : "");
}

// Reports the first wait. Later reports only a wait that is more than twice as long as the last
// reported wait.
class WaitNotes {
  public:
    explicit WaitNotes(Progress& progress) : progress_(progress) {}
    void note(double seconds, const std::filesystem::path& source) {
        if (seconds < 2 * said_s_) return;
        said_s_ = seconds;
        progress_.clear();
        fmt::print(stderr, "stormcellar: waiting {} for {}\n", short_duration(seconds),
                   printable(source.native()));
    }

  private:
    Progress& progress_;
    double said_s_ = 0;
};

int report_stop(const synth::ReplayReport& report, std::size_t items, Interrupt& interrupt) {
    fmt::print(stderr, "stormcellar: interrupted after {} of {}\n", report.files,
               counted(items, "file"));
    for (const auto& unfinished : report.unfinished) {
        fmt::print(stderr, "stormcellar: {} stays unfinished\n", printable(unfinished.native()));
    }
    interrupt.end_by_signal();
    return exit_failed;
}

synth::Delivery delivery_of(const std::string& name) {
    if (name == "growing") return synth::Delivery::growing;
    if (name == "open") return synth::Delivery::open;
    return name == "chunks" ? synth::Delivery::chunks : synth::Delivery::whole;
}

nlohmann::json json_of(const synth::ReplayReport& report, double total_s) {
    nlohmann::json faults = nlohmann::json::array();
    for (const synth::FaultMade& made : report.faults) {
        const auto chunk = made.chunk == 0 ? nlohmann::json() : nlohmann::json(made.chunk);
        faults.push_back({{"fault", synth::to_string(made.fault)},
                          {"source", printable(made.source.native())},
                          {"file", printable(made.name.native())},
                          {"chunk", chunk},
                          {"bytes", made.bytes},
                          {"kept_bytes", made.kept_bytes}});
    }
    nlohmann::json unfinished = nlohmann::json::array();
    for (const auto& name : report.unfinished)
        unfinished.push_back(printable(name.native()));
    return {{"interrupted", report.stopped},
            {"unfinished", unfinished},
            {"files", report.files},
            {"writes", report.writes},
            {"bytes", report.bytes},
            {"faults", faults},
            {"total_s", total_s}};
}

void print_faults(const std::vector<synth::FaultMade>& faults) {
    std::map<synth::Fault, std::size_t> counts;
    for (const synth::FaultMade& made : faults)
        ++counts[made.fault];
    for (const auto& [fault, count] : counts)
        fmt::print(stderr, "{}: {}\n", synth::to_string(fault), count);
}

// Removes the volumes that cannot be sent in chunks, and reports them.
void leave_out_unfit(std::vector<synth::ReplayItem>& items) {
    std::erase_if(items, [](const synth::ReplayItem& item) {
        const auto why = synth::why_not_in_chunks(item);
        if (why.empty()) return false;
        print_note(fmt::format("left out: {}: {}, so it cannot come in chunks",
                               item.source.native(), why));
        return true;
    });
}

int run_replay(const ReplayCommandOptions& options) {
    const auto start = steady_now();
    const std::vector<std::filesystem::path> sources(options.places.begin(),
                                                     options.places.end() - 1);
    synth::ReplayOptions replay_options;
    if (!options.faults.empty()) {
        const auto faults = synth::parse_fault_rates(options.faults);
        if (!faults) return report_error(faults.error());
        replay_options.faults = *faults;
    }
    auto items = synth::find_replay_items(sources);
    if (!items) return report_error(items.error());
    if (delivery_of(options.delivery) == synth::Delivery::chunks) leave_out_unfit(*items);
    if (items->empty()) {
        return report_error({ErrorCode::bad_argument, "none of the files can come in chunks"});
    }
    Interrupt interrupt;
    Progress progress("files", items->size(), !options.json);
    replay_options.delivery = delivery_of(options.delivery);
    replay_options.interval_s = options.interval_s;
    replay_options.speed = options.speed;
    replay_options.stop = &interrupt.flag();
    replay_options.replayed = [&](std::size_t done) { progress.show(done); };
    WaitNotes waits(progress);
    replay_options.waits = [&](double seconds, const auto& source) { waits.note(seconds, source); };
    say_plan(synth::plan_replay(*items, replay_options));
    const auto report =
        synth::replay(*items, options.places.back(), real_file_system(), replay_options);
    progress.clear();
    if (!report) return report_error(report.error());
    const double total_s = seconds_since(start);
    if (options.json) print_json(json_of(*report, total_s));
    if (report->stopped) {
        std::fflush(stdout);  // because a signal that ends the program does not flush
        return report_stop(*report, items->size(), interrupt);
    }
    if (!options.json) {
        fmt::print(stderr, "{}, {} bytes, {:.1f} s\n", counted(report->files, "file"),
                   report->bytes, total_s);
        print_faults(report->faults);
    }
    return exit_done;
}

}  // namespace

Run set_up_replay(CLI::App& replay) {
    const auto options = std::make_shared<ReplayCommandOptions>();
    replay
        .add_option("PLACES", options->places,
                    "Files, archives or directories to replay, and the drop directory as the last")
        ->required()
        ->expected(2, 1'000'000)
        ->option_text("SOURCE... DROP");
    replay
        .add_option("--as", options->delivery,
                    "How the files arrive: whole (the default) renames each file when it is "
                    "complete; growing appends chunk by chunk and closes the file each time; open "
                    "appends and keeps the file open; chunks writes a file for each chunk, "
                    "DROP/STATION/NUMBER/DATE-TIME-CHUNK-S|I|E")
        ->check(CLI::IsMember({"whole", "growing", "open", "chunks"}))
        ->option_text("whole|growing|open|chunks");
    auto* interval = replay.add_option("--interval", options->interval_s,
                                       "Seconds from one file to the next, whatever their times");
    interval->check(CLI::Range(0.0, 86400.0));
    replay
        .add_option("--speed", options->speed,
                    "How many times faster than in real time the files arrive; those of several "
                    "stations are mixed. Default: 1")
        ->check(CLI::Range(0.001, 1e6))
        ->excludes(interval);
    replay
        .add_option("--faults", options->faults,
                    "Faults to make, each with its probability for a chunk (for a file, if files "
                    "are whole): drop=0.01,repeat=0.01,reorder=0.02,truncate=0.005,seed=7. --json "
                    "names each fault that was made")
        ->option_text("SPEC");
    replay.add_flag("--json", options->json, "Print what was done as one JSON document");
    return [options] { return run_replay(*options); };
}

}  // namespace stormcellar::cli

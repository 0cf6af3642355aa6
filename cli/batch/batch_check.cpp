// stormcellar batch check --plan PLAN: counts the tasks that are done or missing, and the files
// that they left out.
#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/byte_size.h"
#include "batch/leftovers.h"
#include "cli/batch/batch.h"
#include "cli/shared/progress.h"
#include "cli/shared/query_options.h"
#include "cli/shared/short_duration.h"

namespace stormcellar::cli {
namespace {

using batch::CheckReport;
using batch::Totals;

constexpr std::size_t most_listed = 20;

struct CheckCommand {
    std::string plan;
    bool deep = false, table = false, list_all = false, clean = false, json = false;
};

std::string numbers_of(const std::vector<std::size_t>& tasks, std::size_t most) {
    std::string text;
    for (std::size_t i = 0; i < std::min(tasks.size(), most); ++i)
        text += fmt::format("{}{}", i == 0 ? "" : " ", tasks[i]);
    return tasks.size() > most ? text + " ..." : text;
}

void print_left_out(const batch::Plan& plan, const CheckReport& report, std::size_t most) {
    const auto& tasks = report.done.with_left_out;
    std::size_t shown = 0;
    for (const batch::LeftOutFile& one : batch::left_out_of(
             plan, {tasks.begin(),
                    tasks.begin() + static_cast<std::ptrdiff_t>(std::min(tasks.size(), most))})) {
        if (shown++ == most) break;
        fmt::print("  left out in task {}: {}: {}\n", one.task, printable(one.file.name),
                   printable(one.file.reason));
    }
}

// Prints a row for each station. For each hour of the day, the row has the number of gridded
// volumes, a minus, and the number of volumes that were left out. Hours without a file show a dot.
void print_table(const Totals& done) {
    fmt::print("{:<7}", "hour");
    for (int hour = 0; hour < 24; ++hour)
        fmt::print("{:>6}", fmt::format("{:02}", hour));
    fmt::print("\n");
    for (const auto& [station, hours] : done.stations) {
        fmt::print("{:<7}", station);
        for (std::size_t hour = 0; hour < 24; ++hour) {
            const auto taken = hours.taken.at(hour), left_out = hours.left_out.at(hour);
            std::string cell = taken + left_out == 0 ? "." : std::to_string(taken);
            if (left_out > 0) cell += fmt::format("-{}", left_out);
            fmt::print("{:>6}", cell);
        }
        fmt::print("\n");
    }
}

nlohmann::json json_of(const batch::Plan& plan, const CheckReport& report) {
    const Totals& done = report.done;
    auto stations = nlohmann::json::object();
    for (const auto& [station, hours] : done.stations)
        stations[station] = {{"taken_by_hour", hours.taken}, {"left_out_by_hour", hours.left_out}};
    auto left_out = nlohmann::json::array();
    for (const batch::LeftOutFile& one : batch::left_out_of(plan, done.with_left_out)) {
        left_out.push_back(
            {{"task", one.task}, {"name", one.file.name}, {"reason", one.file.reason}});
    }
    return {{"tasks", plan.facts().tasks()},
            {"missing", report.missing},
            {"changed", report.changed},
            {"files", done.files},
            {"left_out", left_out},
            {"grids", done.grids},
            {"frames", done.frames},
            {"cpu_s", done.cpu_s},
            {"bytes_read", done.bytes_read},
            {"bytes_written", done.bytes_written},
            {"most_memory_bytes", done.most_memory_bytes},
            {"started", json_time(done.started)},
            {"ended", json_time(done.ended)},
            {"seconds_left",
             report.seconds_left ? nlohmann::json(*report.seconds_left) : nlohmann::json(nullptr)},
            {"stations", stations}};
}

void print_report(const CheckCommand& command, const batch::Plan& plan, const CheckReport& report) {
    const Totals& done = report.done;
    const batch::PlanFacts& facts = plan.facts();
    const double share = facts.cost_s > 0 ? 100 * done.cost_s / facts.cost_s : 0;
    fmt::print(
        "{} of {} {} done ({} of grids, {} of frames, {} of statistics): {:.0f} % of "
        "the work\n",
        done.tasks(), facts.tasks(), plural(facts.tasks(), "task"), done.grid_tasks,
        done.frame_tasks, done.statistics_tasks, report.missing.empty() ? 100 : share);
    fmt::print("{} {}, {} left out, {} read; {} {} and {} {} ({} written by the last runs)\n",
               done.files, plural(done.files, "file"), done.left_out,
               format_byte_size(done.bytes_read), done.grids, plural(done.grids, "grid"),
               done.frames, plural(done.frames, "frame"), format_byte_size(done.bytes_written));
    fmt::print("{} of a processor; the largest task took {} of memory\n",
               short_duration(done.cpu_s), format_byte_size(done.most_memory_bytes));
    print_left_out(plan, report,
                   command.list_all ? done.with_left_out.size() + done.left_out : most_listed);
    if (!report.changed.empty()) {
        fmt::print("grids are missing, or are other ones than were made, in tasks: {}\n",
                   numbers_of(report.changed, most_listed));
    }
    if (!report.missing.empty()) {
        fmt::print("not done: {} {}: {}\n", report.missing.size(),
                   plural(report.missing.size(), "task"), numbers_of(report.missing, most_listed));
        if (report.seconds_left) fmt::print("about {} left\n", short_duration(report.seconds_left));
    }
    if (command.table) print_table(done);
}

int run_check(const CheckCommand& command) {
    const auto plan = batch::Plan::open(command.plan);
    if (!plan) return report_error(plan.error());
    const auto report = check_with_bar(*plan, command.deep, command.json);
    if (!report) return report_error(report.error());
    if (command.json) {
        print_json(json_of(*plan, *report));
    } else {
        print_report(command, *plan, *report);
    }
    if (!report->missing.empty()) return exit_incomplete;
    if (command.clean) {
        const std::size_t removed = batch::remove_all_leftovers(*plan);
        if (removed > 0)
            print_note(fmt::format("removed {} temporary {} of killed tasks", removed,
                                   plural(removed, "file")));
    }
    return exit_done;
}

}  // namespace

Result<CheckReport> check_with_bar(const batch::Plan& plan, bool deep, bool quiet) {
    Progress bar("tasks", plan.facts().tasks(), !quiet);
    batch::CheckOptions options;
    options.deep = deep;
    options.progress = [&](std::size_t done, std::size_t all) { bar.show(done, all); };
    auto report = batch::check(plan, options);
    bar.clear();
    return report;
}

Run set_up_batch_check(CLI::App& command) {
    const auto options = std::make_shared<CheckCommand>();
    add_plan_option(command, options->plan);
    command.add_flag("--table", options->table,
                     "Also print how many volumes of each station were gridded in each hour of the "
                     "day, and after a minus how many were left out");
    command.add_flag("--list", options->list_all, "Name all files that were left out");
    command.add_flag("--deep", options->deep,
                     "Compare the grids in the cache with the records, which takes long");
    command.add_flag("--clean", options->clean,
                     "Once all is done, remove temporary files that killed tasks left");
    command.add_flag("--json", options->json, "Print one JSON document");
    return [options] { return run_check(*options); };
}

}  // namespace stormcellar::cli

// stormcellar batch run --plan PLAN --task N|N-M, and batch merge: run tasks of a plan.
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>

#include "base/byte_size.h"
#include "batch/frame_task.h"
#include "batch/grid_task.h"
#include "batch/statistics_task.h"
#include "cli/batch/batch.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/scratch_directory.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using batch::Task;
using batch::TaskOutcome;

struct TaskRange {
    std::size_t first = 0, last = 0;
};

struct TaskCommand {
    std::string plan, tasks;
    int threads = 1;
    bool merges = false;
};

Result<TaskRange> parse_tasks(const std::string& text) {
    TaskRange range;
    const char* const end = text.data() + text.size();
    auto [at, error] = std::from_chars(text.data(), end, range.first);
    range.last = range.first;
    if (error == std::errc{} && at != end && *at == '-') {
        const auto second = std::from_chars(at + 1, end, range.last);
        at = second.ptr;
        error = second.ec;
    }
    if (error != std::errc{} || at != end || range.last < range.first) {
        return fail(ErrorCode::bad_argument,
                    "--task takes a number or a range, as in 12 or 12-19, not '{}'", text);
    }
    return range;
}

// Returns the exit status for a failed task. Returns exit_try_again only if the system failed:
// after any other failure, a second try would fail on the same data and plan.
int status_of(const Error& error) {
    if (error.cause() == Cause::system) return exit_try_again;
    return error.code == ErrorCode::bad_argument ? exit_bad_usage : exit_failed;
}

std::string name_of(const Task& task) {
    if (const auto* const hour = std::get_if<batch::FrameHour>(&task.work)) {
        return fmt::format("frames {} to {}", format_utc(hour->from), format_utc(hour->to));
    }
    if (const auto* const part = std::get_if<batch::MonthHour>(&task.work)) {
        return fmt::format("statistics of {}-{:02}, hour {:02}", part->year, part->month,
                           part->hour);
    }
    const auto& day = std::get<batch::StationDay>(task.work);
    return fmt::format("{} {}", day.station, format_compact(UtcTime{day.day}).substr(0, 8));
}

void say_done(const Task& task, const TaskOutcome& outcome) {
    const batch::Record& record = outcome.record;
    for (const batch::NamedReason& file : record.left_out) {
        fmt::print(stderr, "stormcellar: left out: {}: {}\n", printable(file.name),
                   printable(file.reason));
    }
    if (outcome.stood) {
        fmt::print("task {}: {}: already done\n", task.number, name_of(task));
        return;
    }
    const bool is_grids = task.kind() == batch::TaskKind::grids;
    const std::string of_files =
        !is_grids ? ""
                  : fmt::format("{} {}, {} left out, ", record.files, plural(record.files, "file"),
                                record.left_out.size());
    fmt::print("task {}: {}: {}{} {}, {} written, {:.1f} s of CPU time\n", task.number,
               name_of(task), of_files, record.grids,
               plural(record.grids, is_grids ? "grid" : "frame"),
               format_byte_size(record.bytes_written), record.cpu_s);
}

Result<TaskOutcome> run_by_kind(const batch::Plan& plan, const Task& task,
                                const batch::TaskOptions& options) {
    switch (task.kind()) {
        case batch::TaskKind::grids:
            return batch::run_grid_task(plan, task, options);
        case batch::TaskKind::frames:
            return batch::run_frame_task(plan, task, options);
        case batch::TaskKind::statistics:
            break;
    }
    return batch::run_statistics_task(plan, task, options);
}

Result<TaskOutcome> run_task(const batch::Plan& plan, const Task& task, const fs::path& scratch,
                             const TaskCommand& command, const std::atomic<bool>& stop) {
    const fs::path own = scratch / std::to_string(task.number);
    std::error_code error;
    fs::create_directory(own, error);
    if (error) return fail(ErrorCode::io, "{}: {}", own.native(), error.message());
    const batch::TaskOptions options{command.threads, own, stop};
    auto outcome = run_by_kind(plan, task, options);
    fs::remove_all(own, error);
    return outcome;
}

// Runs a range of tasks, and goes on after a failure. Returns the status of the last task that no
// other try can help. If there is no such task, returns exit_try_again if any task failed or an
// interrupt came, else exit_done. A number that is not in the plan, or a task of the wrong kind,
// ends the run with the status of that error.
int run_tasks(const TaskCommand& command) {
    const auto range = parse_tasks(command.tasks);
    if (!range) return report_error(range.error());
    const auto plan = batch::Plan::open(command.plan);
    if (!plan) return report_error(plan.error());
    const auto scratch = ScratchDirectory::make();
    if (!scratch) return report_error(scratch.error());
    Interrupt interrupt;
    int worst = exit_done;
    for (std::size_t number = range->first; number <= range->last && !interrupt.flag(); ++number) {
        const auto task = plan->task(number);
        if (!task) return report_error(task.error());
        if ((task->kind() != batch::TaskKind::grids) != command.merges) {
            return report_error(
                {ErrorCode::bad_argument, fmt::format("task {} is for stormcellar batch {}", number,
                                                      command.merges ? "run" : "merge")});
        }
        const auto outcome = run_task(*plan, *task, scratch->path(), command, interrupt.flag());
        if (outcome) {
            say_done(*task, *outcome);
            continue;
        }
        fmt::print(stderr, "stormcellar: task {}: {}: {}\n", number, name_of(*task),
                   printable(outcome.error().message));
        const int status = status_of(outcome.error());
        worst = worst == exit_done || status != exit_try_again ? status : worst;
    }
    return interrupt.flag() && worst == exit_done ? exit_try_again : worst;
}

Run set_up(CLI::App& command, bool merges) {
    const auto options = std::make_shared<TaskCommand>();
    options->merges = merges;
    add_plan_option(command, options->plan);
    command
        .add_option("--task", options->tasks,
                    "Number of the task in the plan, or a range of them, as in 12-19")
        ->required();
    command.add_option("--threads", options->threads, "Number of threads")
        ->capture_default_str()
        ->check(CLI::Range(1, 256));
    return [options] { return run_tasks(*options); };
}

}  // namespace

Run set_up_batch_run(CLI::App& command) {
    return set_up(command, false);
}

Run set_up_batch_merge(CLI::App& command) {
    return set_up(command, true);
}

}  // namespace stormcellar::cli

// stormcellar batch submit --plan PLAN --engine slurm|make|local: runs the tasks that are not done.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>
#include <thread>

#include <CLI/CLI.hpp>
#include <sys/stat.h>
#include <sys/wait.h>

#include "batch/engines.h"
#include "cli/batch/batch.h"
#include "cli/batch/task_pool.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/progress.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using batch::quoted;

struct SubmitCommand {
    std::string plan, engine, program;
    batch::EngineOptions options;
    bool deep = false, dry_run = false;
};

int default_jobs() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Status write_text(const fs::path& path, const std::string& text) {
    return write_file_atomically(real_file_system(), path, std::as_bytes(std::span(text)));
}

// Runs a shell command and returns its output.
Result<std::string> output_of(const std::string& command) {
    std::FILE* const pipe = ::popen(command.c_str(), "re");
    if (pipe == nullptr) return fail(ErrorCode::exhausted, "{}: cannot be run", command);
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
        text += static_cast<char>(c);
    const int status = ::pclose(pipe);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return fail(ErrorCode::io, "{}: failed", command);
    }
    while (text.ends_with('\n'))
        text.pop_back();
    return text;
}

std::string sbatch_command(const fs::path& script, const std::string& after) {
    // Frame tasks check the records of their grid tasks, so they may begin even if grid tasks
    // failed.
    const std::string dependency =
        after.empty() ? "" : fmt::format(" --dependency=afterany:{}", after);
    return fmt::format("sbatch --parsable{} {}", dependency, quoted(script.native()));
}

int submit_to_slurm(const SubmitCommand& command, const batch::Plan& plan,
                    const batch::TaskLists& tasks) {
    std::string after;
    for (const batch::SlurmJob& job : batch::slurm_jobs(plan, tasks, command.options)) {
        const fs::path script = plan.directory() / (job.name + ".sh");
        if (command.dry_run) {
            fmt::print("{}\n{}\n", job.text, sbatch_command(script, after));
            after = "JOB";
            continue;
        }
        std::error_code error;
        fs::create_directories(plan.directory() / "log", error);
        if (Status written = write_text(script, job.text); !written) {
            return report_error(written.error());
        }
        const auto number = output_of(sbatch_command(script, after));
        if (!number) return report_error(number.error());
        after = number->substr(0, number->find(';'));  // the name of a cluster may follow
        fmt::print("{}: job {}\n", job.name, after);
    }
    return exit_done;
}

int submit_to_make(const SubmitCommand& command, const batch::Plan& plan,
                   const batch::TaskLists& tasks) {
    const auto text = batch::makefile_of(plan, tasks, command.options);
    if (!text) return report_error(text.error());
    const fs::path path = plan.directory() / "Makefile";
    const int jobs = command.options.jobs > 0 ? command.options.jobs : default_jobs();
    const std::string make = fmt::format("make -k -j {} -f {}", jobs, quoted(path.native()));
    if (command.dry_run) {
        fmt::print("{}\n{}\n", *text, make);
        return exit_done;
    }
    if (Status written = write_text(path, *text); !written) return report_error(written.error());
    const int status = std::system(make.c_str());
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? exit_done : exit_failed;
}

int submit_locally(const SubmitCommand& command, const batch::Plan& plan,
                   const batch::TaskLists& tasks) {
    PoolJob job{command.options.program, plan.directory(), "run", command.options.jobs,
                command.options.threads};
    if (job.jobs == 0) job.jobs = default_jobs();
    if (command.dry_run) {
        fmt::print("{} processes at a time, of tasks", job.jobs);
        const char* before = " ";
        for (const auto* const numbers : {&tasks.grids, &tasks.frames, &tasks.statistics}) {
            if (numbers->empty()) continue;
            fmt::print("{}{}", before, fmt::join(*numbers, " "));
            before = ", then ";
        }
        fmt::print("\n");
        return exit_done;
    }
    Interrupt interrupt;
    std::size_t failed = 0;
    for (const auto& [name, numbers] :
         {std::pair{"run", &tasks.grids}, std::pair{"merge", &tasks.frames},
          std::pair{"merge", &tasks.statistics}}) {
        if (interrupt.flag()) break;
        job.command = name;
        const auto ended = run_pool(job, *numbers, interrupt.flag(), [](std::size_t) {});
        if (!ended) return report_error(ended.error());
        failed += ended->size();
    }
    interrupt.end_by_signal();
    if (failed == 0) return exit_done;
    fmt::print(stderr, "stormcellar: {} {} failed; the same command tries them again\n", failed,
               plural(failed, "task"));
    return exit_failed;
}

int run_submit(SubmitCommand command) {
    const auto plan = batch::Plan::open(command.plan);
    if (!plan) return report_error(plan.error());
    std::error_code error;
    command.options.program = command.program.empty() ? fs::read_symlink("/proc/self/exe", error)
                                                      : fs::path(command.program);
    if (Status named = batch::check_names(*plan, command.options); !named)
        return report_error(named.error());
    const auto report = check_with_bar(*plan, command.deep, false);
    if (!report) return report_error(report.error());
    const batch::TaskLists tasks = batch::lists_of(*plan, report->missing);
    if (report->missing.empty()) {
        fmt::print("all {} {} done\n", plan->facts().tasks(),
                   plan->facts().tasks() == 1 ? "task is" : "tasks are");
        return exit_done;
    }
    if (command.engine == "slurm") return submit_to_slurm(command, *plan, tasks);
    if (command.engine == "make") return submit_to_make(command, *plan, tasks);
    return submit_locally(command, *plan, tasks);
}

}  // namespace

Run set_up_batch_submit(CLI::App& command) {
    const auto options = std::make_shared<SubmitCommand>();
    add_plan_option(command, options->plan);
    command
        .add_option("--engine", options->engine,
                    "What runs the tasks: slurm (job arrays), make, or local (processes of this "
                    "machine)")
        ->required()
        ->check(CLI::IsMember({"slurm", "make", "local"}));
    command
        .add_option("--jobs", options->options.jobs,
                    "Number of tasks at a time. Default: all processors; with slurm no limit")
        ->check(CLI::Range(1, 100'000));
    command.add_option("--threads", options->options.threads, "Number of threads of each task")
        ->capture_default_str()
        ->check(CLI::Range(1, 256));
    command.add_option("--partition", options->options.partition, "Partition of Slurm");
    command
        .add_option("--array-size", options->options.array_size,
                    "Largest number of elements of a job array: one less than Slurm's MaxArraySize")
        ->capture_default_str()
        ->check(CLI::Range(1, 4'000'000));
    command.add_option("--program", options->program,
                       "Path of stormcellar on the machines that run tasks. Default: this program");
    command.add_flag("--deep", options->deep,
                     "Also run the tasks whose grids are missing from the cache");
    command.add_flag("--dry-run", options->dry_run,
                     "Print the scripts and commands, and run nothing");
    return [options] { return run_submit(*options); };
}

}  // namespace stormcellar::cli

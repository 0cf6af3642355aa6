#include "batch/engines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/printable.h"
#include "batch/resources.h"

namespace stormcellar::batch {
namespace {

// The tasks of one kind, which become a job array.
struct Step {
    const char* name;        // "grids"
    const char* command;     // subcommand of `stormcellar batch`
    std::size_t first, end;  // numbers of the tasks, [first, end)
    Resources needed;        // resources of one task
};

// Returns the numbers as ranges, such as "0-3,7,9-11".
std::string ranges_of(const std::set<std::size_t>& numbers) {
    std::string text;
    for (auto at = numbers.begin(); at != numbers.end();) {
        const std::size_t first = *at;
        std::size_t last = first;
        while (++at != numbers.end() && *at == last + 1)
            last = *at;
        text += fmt::format("{}{}", text.empty() ? "" : ",", first);
        if (last != first) text += fmt::format("-{}", last);
    }
    return text;
}

std::uint64_t mebibytes(std::uint64_t bytes) {
    return (bytes + (std::uint64_t{1} << 20) - 1) >> 20;
}

SlurmJob job_of(const Plan& plan, const Step& step, const std::vector<std::size_t>& missing,
                const EngineOptions& options) {
    const std::size_t tasks = step.end - step.first;
    const std::size_t each = (tasks + options.array_size - 1) / options.array_size;
    std::set<std::size_t> elements;
    for (const std::size_t number : missing)
        elements.insert((number - step.first) / each);
    const std::string limit = options.jobs > 0 ? fmt::format("%{}", options.jobs) : "";
    const std::string partition =
        options.partition.empty() ? "" : fmt::format("#SBATCH --partition={}\n", options.partition);
    const double minutes = std::ceil(step.needed.seconds_of(each) / 60);
    const std::string plan_path = plan.directory().native();
    return {step.name,
            fmt::format("#!/bin/bash\n"
                        "# Made by stormcellar batch submit. A task needs {} MiB of $TMPDIR, which "
                        "should be a local disk.\n"
                        "#SBATCH --job-name=stormcellar-{}\n"
                        "#SBATCH --array={}{}\n"
                        "#SBATCH --cpus-per-task={}\n"
                        "#SBATCH --mem={}M\n"
                        "#SBATCH --time={:.0f}\n"
                        "{}"
                        "#SBATCH --requeue\n"
                        "#SBATCH --open-mode=append\n"
                        "#SBATCH --output=\"{}/log/{}-%a.txt\"\n"
                        "first=$(({} + SLURM_ARRAY_TASK_ID * {}))\n"
                        "last=$((first + {}))\n"
                        "((last < {})) || last={}\n"
                        "exec {} batch {} --plan {} --task \"$first-$last\" --threads {}\n",
                        mebibytes(step.needed.scratch_bytes), step.name, ranges_of(elements), limit,
                        options.threads, mebibytes(step.needed.memory_bytes), minutes, partition,
                        plan_path, step.name, step.first, each, each - 1, step.end, step.end - 1,
                        quoted(options.program.native()), step.command, quoted(plan_path),
                        options.threads)};
}

std::string targets_of(const char* kind, const std::vector<std::size_t>& numbers) {
    std::string text;
    for (const std::size_t number : numbers)
        text += fmt::format(" {}-{}", kind, number);
    return text;
}

// Quotes a text for a variable of a Makefile: doubles each dollar, and puts a backslash before each
// #, which would otherwise begin a comment. Doubles backslashes before a #.
std::string in_makefile(const std::string& text) {
    std::string escaped;
    std::size_t backslashes = 0;
    for (const char c : text) {
        if (c == '$') escaped += '$';
        if (c == '#') escaped += std::string(backslashes + 1, '\\');
        backslashes = c == '\\' ? backslashes + 1 : 0;
        escaped += c;
    }
    return escaped;
}

}  // namespace

std::string quoted(const std::string& text) {
    std::string in_quotes = "'";
    for (const char c : text) {
        if (c == '\'') {
            in_quotes += "'\\''";
        } else {
            in_quotes += c;
        }
    }
    return in_quotes + "'";
}

Status check_names(const Plan& plan, const EngineOptions& options) {
    const auto refuse = [](std::string_view what, const std::string& name) {
        return fail(ErrorCode::bad_argument, "{}: {}", printable(name), what);
    };
    for (const std::filesystem::path& path : {plan.directory(), options.program}) {
        if (!is_plan_text(path.native()))
            return refuse(
                "a script cannot hold this path: it has control characters or is no UTF-8",
                path.native());
    }
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view{"_-.,+"}.find(c) != std::string_view::npos;
    };
    if (!std::ranges::all_of(options.partition, is_plain))
        return refuse("is not the name of a partition", options.partition);
    return {};
}

TaskLists lists_of(const Plan& plan, const std::vector<std::size_t>& missing) {
    TaskLists lists;
    const PlanFacts& facts = plan.facts();
    const std::size_t first_statistics = facts.grid_tasks + facts.frame_tasks;
    for (const std::size_t number : missing) {
        auto& list = number < facts.grid_tasks   ? lists.grids
                     : number < first_statistics ? lists.frames
                                                 : lists.statistics;
        list.push_back(number);
    }
    return lists;
}

std::vector<SlurmJob> slurm_jobs(const Plan& plan, const TaskLists& tasks,
                                 const EngineOptions& options) {
    const std::size_t grids = plan.facts().grid_tasks, frames = grids + plan.facts().frame_tasks;
    std::vector<SlurmJob> jobs;
    if (!tasks.grids.empty()) {
        const Step step{"grids", "run", 0, grids, resources_of_grids(plan, options.threads)};
        jobs.push_back(job_of(plan, step, tasks.grids, options));
    }
    if (!tasks.frames.empty()) {
        const Step step{"frames", "merge", grids, frames,
                        resources_of_frames(plan, options.threads)};
        jobs.push_back(job_of(plan, step, tasks.frames, options));
    }
    if (!tasks.statistics.empty()) {
        const Step step{"statistics", "merge", frames, plan.facts().tasks(),
                        resources_of_statistics(plan)};
        jobs.push_back(job_of(plan, step, tasks.statistics, options));
    }
    return jobs;
}

Result<std::string> makefile_of(const Plan& plan, const TaskLists& tasks,
                                const EngineOptions& options) {
    std::string text = fmt::format(
        "# Made by stormcellar batch submit: make -k -j JOBS runs the tasks that are not done.\n"
        "RUN = @{0} batch run --plan {1} --threads {2} --task\n"
        "MERGE = @{0} batch merge --plan {1} --threads {2} --task\n"
        "GRIDS ={3}\n"
        "FRAMES ={4}\n"
        "STATISTICS ={5}\n"
        ".PHONY: all $(GRIDS) $(FRAMES) $(STATISTICS)\n"
        "all: $(GRIDS) $(FRAMES) $(STATISTICS)\n"
        "$(GRIDS): grid-%:\n\t$(RUN) $*\n"
        "$(FRAMES): frame-%:\n\t$(MERGE) $*\n"
        "$(STATISTICS): statistics-%:\n\t$(MERGE) $*\n"
        "$(STATISTICS): $(FRAMES)\n",
        in_makefile(quoted(options.program.native())),
        in_makefile(quoted(plan.directory().native())), options.threads,
        targets_of("grid", tasks.grids), targets_of("frame", tasks.frames),
        targets_of("statistics", tasks.statistics));
    // All hours of a day need the same grids, so group the tasks by the grids that they need, and
    // write each group's needs once.
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> by_needs;
    for (const std::size_t number : tasks.frames) {
        const auto task = plan.task(number);
        if (!task) return pass_on(task);
        const auto& hour = std::get<FrameHour>(task->work);
        by_needs[{hour.first_need, hour.end_need}].push_back(number);
    }
    for (const auto& [needs, frames] : by_needs) {
        const auto first = std::ranges::lower_bound(tasks.grids, needs.first);
        const auto end = std::ranges::lower_bound(tasks.grids, needs.second);
        if (first == end) continue;
        text += fmt::format("{}: needs-{}-{}\nneeds-{}-{}:{}\n.PHONY: needs-{}-{}\n",
                            targets_of("frame", frames).substr(1), needs.first, needs.second,
                            needs.first, needs.second, targets_of("grid", {first, end}),
                            needs.first, needs.second);
    }
    return text;
}

}  // namespace stormcellar::batch

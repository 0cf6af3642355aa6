// stormcellar batch statistics --plan PLAN --by hour|month|all -o FILE.nc: writes a climatology.
#include <map>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>

#include "batch/statistics_task.h"
#include "cli/batch/batch.h"
#include "cli/shared/progress.h"
#include "export/climatology_netcdf.h"

namespace stormcellar::cli {
namespace {

struct StatisticsCommand {
    std::string plan, by{"hour"}, output;
    bool quiet = false;
};

int group_of(const batch::MonthHour& part, const std::string& by) {
    if (by == "hour") return part.hour;
    return by == "month" ? static_cast<int>(part.month) : 0;
}

// Adds the counts of each month and hour to their group.
Result<std::vector<netcdf::TallyGroup>> sum_up(const batch::Plan& plan,
                                               const StatisticsCommand& command) {
    std::map<int, netcdf::TallyGroup> groups;
    const batch::PlanFacts& facts = plan.facts();
    const std::size_t first = facts.grid_tasks + facts.frame_tasks;
    Progress bar("months", facts.statistics_tasks, !command.quiet);
    for (std::size_t number = first; number < facts.tasks(); ++number) {
        bar.show(number - first);
        const auto task = plan.task(number);
        if (!task) return pass_on(task);
        const auto& part = std::get<batch::MonthHour>(task->work);
        auto more = batch::read_tally(plan, part);
        if (!more) return pass_on(more);
        const int group = group_of(part, command.by);
        const auto found = groups.find(group);
        if (found == groups.end()) {
            groups.emplace(group,
                           netcdf::TallyGroup{group, more->instants, std::move(more->tally)});
            continue;
        }
        found->second.instants += more->instants;
        if (Status added = found->second.tally.add(more->tally); !added) return pass_on(added);
    }
    std::vector<netcdf::TallyGroup> sums;
    for (auto& [number, group] : groups)
        sums.push_back(std::move(group));
    return sums;
}

int run_statistics(const StatisticsCommand& command) {
    const auto plan = batch::Plan::open(command.plan);
    if (!plan) return report_error(plan.error());
    if (plan->facts().statistics_tasks == 0) {
        return report_error(
            {ErrorCode::bad_argument, "this plan has no statistics; make one with --statistics"});
    }
    if (Status good = check_target(command.output); !good) return report_error(good.error());
    const auto groups = sum_up(*plan, command);
    if (!groups) return report_error(groups.error());
    const batch::Recipe& recipe = plan->recipe();
    const netcdf::ClimatologyText text{command.by.c_str(), format_utc(recipe.from),
                                       format_utc(recipe.to), recipe.source};
    const Status written =
        netcdf::write_climatology(real_file_system(), command.output, *groups, text);
    return written ? exit_done : report_error(written.error());
}

}  // namespace

Run set_up_batch_statistics(CLI::App& command) {
    const auto options = std::make_shared<StatisticsCommand>();
    add_plan_option(command, options->plan);
    command
        .add_option("--by", options->by,
                    "How to group the frames: by hour (of the day, UTC), by month (of the year) or "
                    "all in one group")
        ->capture_default_str()
        ->check(CLI::IsMember({"hour", "month", "all"}));
    command.add_option("-o,--output", options->output, "The netCDF file to write")->required();
    command.add_flag("--quiet", options->quiet, "Show no progress");
    return [options] { return run_statistics(*options); };
}

}  // namespace stormcellar::cli

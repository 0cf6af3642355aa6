// stormcellar batch plan|run|merge|check|submit: grids archives on many machines.
#include "cli/batch/batch.h"

#include <array>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace stormcellar::cli {
namespace {

struct BatchCommand {
    const char* name;
    const char* summary;
    Run (*set_up)(CLI::App& command);
};

constexpr std::array commands{
    BatchCommand{"plan", "Write the tasks that make an archive's grids, without running them",
                 set_up_batch_plan},
    BatchCommand{"run", "Grid what one station sent on one day (exit status 75: try again)",
                 set_up_batch_run},
    BatchCommand{"merge", "Make the frames of one hour, or count those of a month",
                 set_up_batch_merge},
    BatchCommand{"check", "Show what is done, missing and left out, and the time left",
                 set_up_batch_check},
    BatchCommand{"statistics", "Write the climatology of a plan's frames as netCDF",
                 set_up_batch_statistics},
    BatchCommand{"submit", "Let Slurm, make or this machine run the tasks that are not done",
                 set_up_batch_submit},
};

}  // namespace

void add_plan_option(CLI::App& app, std::string& plan) {
    app.add_option("--plan", plan, "Directory of the plan")->required();
}

Run set_up_batch(CLI::App& command) {
    command.require_subcommand(1);
    std::vector<std::pair<CLI::App*, Run>> all;
    for (const BatchCommand& one : commands) {
        CLI::App* app = command.add_subcommand(one.name, one.summary);
        all.emplace_back(app, one.set_up(*app));
    }
    return [all = std::move(all)] {
        for (const auto& [app, run] : all) {
            if (app->parsed()) return run();
        }
        return static_cast<int>(exit_bad_usage);
    };
}

}  // namespace stormcellar::cli

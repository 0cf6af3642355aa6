// cli/batch/batch.h -- code that the subcommands of `stormcellar batch` share.
//
// Threads   One thread at a time.
#pragma once

#include <functional>

#include "batch/check.h"
#include "batch/plan.h"
#include "cli/shared/commands.h"

namespace stormcellar::cli {

// Exit status of a task that failed but may succeed in another try or on another machine
// (EX_TEMPFAIL).
inline constexpr int exit_try_again = 75;
// Exit status of a check that finds unfinished tasks.
inline constexpr int exit_incomplete = 3;

void add_plan_option(CLI::App& app, std::string& plan);

Run set_up_batch_plan(CLI::App& command);
Run set_up_batch_run(CLI::App& command);
Run set_up_batch_merge(CLI::App& command);
Run set_up_batch_check(CLI::App& command);
Run set_up_batch_statistics(CLI::App& command);
Run set_up_batch_submit(CLI::App& command);

// Checks a plan, with a progress bar on stderr.
[[nodiscard]] Result<batch::CheckReport> check_with_bar(const batch::Plan& plan, bool deep,
                                                        bool quiet);

}  // namespace stormcellar::cli

// cli/subcommands.h -- the registry of the subcommands of `stormcellar`.
//
// The registry has one row for each subcommand. The dispatch in main.cpp, the overview of --help,
// the manual pages and the completions of shells all use these rows.
// Thread contract: the registry is constant.
#pragma once

#include <span>
#include <string_view>

#include "cli/shared/commands.h"

namespace stormcellar::cli {

struct Subcommand {
    const char* name;     // "grid"
    const char* summary;  // one line for the overview and the top of the command's help and manual
    Run (*set_up)(CLI::App& command);
    const char* footer = "";  // text below the options in its help
};

// sorted by name, as --help shows them
[[nodiscard]] std::span<const Subcommand> subcommands();
// Returns the subcommand of this name, or null if there is none.
[[nodiscard]] const Subcommand* find_subcommand(std::string_view name);

// Adds a subcommand to the program.
[[nodiscard]] Command add_subcommand(CLI::App& app, const Subcommand& subcommand);

}  // namespace stormcellar::cli

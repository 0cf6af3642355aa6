// cli/subcommands.h -- the registry of the subcommands of `stormcellar`.
//
// One row a subcommand. The dispatch of main.cpp, the overview of --help, the manual pages and the
// completions of shells all come from it.
// Thread contract: the registry is constant.
#pragma once

#include <span>
#include <string_view>

#include "cli/shared/commands.h"

namespace stormcellar::cli {

struct Subcommand {
    const char* name;     // "grid"
    const char* summary;  // one line: in the overview, and first in its own help and manual
    Run (*set_up)(CLI::App& command);
    const char* footer = "";  // what its help says below the options
};

// sorted by name, as --help shows them
[[nodiscard]] std::span<const Subcommand> subcommands();
// Null: there is none of this name.
[[nodiscard]] const Subcommand* find_subcommand(std::string_view name);

// Puts a subcommand on the program.
[[nodiscard]] Command add_subcommand(CLI::App& app, const Subcommand& subcommand);

}  // namespace stormcellar::cli

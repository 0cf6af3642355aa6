#include <algorithm>

#include <CLI/CLI.hpp>

#include "cli/subcommands.h"

namespace stormcellar::cli {

const Subcommand* find_subcommand(std::string_view name) {
    const auto all = subcommands();
    const auto found = std::ranges::find(all, name, &Subcommand::name);
    return found == all.end() ? nullptr : &*found;
}

Command add_subcommand(CLI::App& app, const Subcommand& subcommand) {
    CLI::App* command = app.add_subcommand(subcommand.name, subcommand.summary);
    command->footer(subcommand.footer);
    return {command, subcommand.set_up(*command)};
}

}  // namespace stormcellar::cli

#include "cli/subcommands.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>

namespace stormcellar::cli {

// Each is defined in the file of its subcommand.
Run set_up_accuracy(CLI::App& command);
Run set_up_cache(CLI::App& command);
Run set_up_catalog(CLI::App& command);
Run set_up_fetch(CLI::App& command);
Run set_up_frame(CLI::App& command);
Run set_up_grid(CLI::App& command);
Run set_up_info(CLI::App& command);
Run set_up_loop(CLI::App& command);
Run set_up_replay(CLI::App& command);
Run set_up_status(CLI::App& command);
Run set_up_synth(CLI::App& command);

namespace {

constexpr std::array registry{
    Subcommand{"accuracy", "Show what accuracy costs in time, rung by rung", set_up_accuracy},
    Subcommand{"cache", "The cache of grids: look, evict, pin", set_up_cache},
    Subcommand{"catalog", "Query the catalog of raw files", set_up_catalog},
    Subcommand{"fetch", "Fetch raw volumes of stations and times from a public bucket",
               set_up_fetch},
    Subcommand{"frame", "Draw one still picture of a grid in the cache", set_up_frame},
    Subcommand{"grid", "Grid Level II files, of one site or of many, as netCDF", set_up_grid},
    Subcommand{"info", "Decode a Level II file and describe it", set_up_info},
    Subcommand{"loop", "Draw the grids of a time range as a looping animation", set_up_loop,
               "A grid file that is damaged is named on stderr and left out; the exit status is 0 "
               "when at least one frame was written.\n"},
    Subcommand{"replay",
               "Play files into a drop directory as LDM would, in the order of their times",
               set_up_replay},
    Subcommand{"status", "What the running daemon says of itself", set_up_status},
    Subcommand{"synth", "Write the Level II files of a simulated scene, the same bytes every time",
               set_up_synth},
};

}  // namespace

std::span<const Subcommand> subcommands() {
    return registry;
}

const Subcommand* find_subcommand(std::string_view name) {
    const auto found = std::ranges::find(registry, name, &Subcommand::name);
    return found == registry.end() ? nullptr : &*found;
}

Command add_subcommand(CLI::App& app, const Subcommand& subcommand) {
    CLI::App* command = app.add_subcommand(subcommand.name, subcommand.summary);
    command->footer(subcommand.footer);
    return {command, subcommand.set_up(*command)};
}

}  // namespace stormcellar::cli

#include "cli/subcommands.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>

namespace stormcellar::cli {

// Each of these functions is defined in the file of its subcommand.
Run set_up_accuracy(CLI::App& command);
Run set_up_batch(CLI::App& command);
Run set_up_cache(CLI::App& command);
Run set_up_catalog(CLI::App& command);
Run set_up_cells(CLI::App& command);
Run set_up_cyclone(CLI::App& command);
Run set_up_fetch(CLI::App& command);
Run set_up_frame(CLI::App& command);
Run set_up_grid(CLI::App& command);
Run set_up_help(CLI::App& command);
Run set_up_info(CLI::App& command);
Run set_up_loop(CLI::App& command);
Run set_up_nowcast(CLI::App& command);
Run set_up_profile(CLI::App& command);
Run set_up_replay(CLI::App& command);
Run set_up_serve(CLI::App& command);
Run set_up_status(CLI::App& command);
Run set_up_synth(CLI::App& command);
Run set_up_view(CLI::App& command);

namespace {

// The program stormcellar-first has only frame, replay and synth. scripts/demo uses it for its
// first picture.
constexpr std::array registry{
#ifndef STORMCELLAR_FIRST
    Subcommand{"accuracy", "Measure the error and the time of each way to grid a volume",
               set_up_accuracy},
    Subcommand{"batch", "Make the grids and frames of an archive on many machines", set_up_batch},
    Subcommand{"cache", "List, verify, pin and evict the grids in the cache", set_up_cache},
    Subcommand{"catalog", "Query, check and rebuild the catalog of raw files", set_up_catalog},
    Subcommand{"cells", "Find storm cells, follow them and forecast their places", set_up_cells},
    Subcommand{"cyclone", "Measure the center, wind and pressure of a hurricane", set_up_cyclone,
               "If the velocities cannot show a hurricane, the command says why. The exit status "
               "is then 3.\n"},
    Subcommand{"fetch", "Fetch raw volumes by station and time from a public bucket", set_up_fetch},
#endif
    Subcommand{"frame", "Draw a still picture of Level II files, or of a grid in the cache",
               set_up_frame},
#ifndef STORMCELLAR_FIRST
    Subcommand{"grid", "Grid Level II files of one or more sites and write netCDF", set_up_grid},
    Subcommand{"help", "Show what a command can do, with examples", set_up_help},
    Subcommand{"info", "Decode a Level II file and describe it", set_up_info},
    Subcommand{"loop", "Draw Level II files, or grids in the cache, as a loop that moves",
               set_up_loop,
               "The command names each damaged grid file on standard error and leaves it out. The "
               "exit status is 0 if at least one frame was written.\n"},
    Subcommand{"nowcast", "Move the latest echo up to an hour ahead, with the measured error",
               set_up_nowcast},
    Subcommand{"profile", "Measure the wind above a radar by height, and draw a hodograph",
               set_up_profile},
#endif
    Subcommand{"replay",
               "Replay files into a drop directory as LDM would, in the order of their times",
               set_up_replay},
#ifndef STORMCELLAR_FIRST
    Subcommand{"serve", "Serve files, or a cache and a catalog, over HTTP until Ctrl-C",
               set_up_serve},
    Subcommand{"status", "Show the status of the running daemon", set_up_status},
#endif
    Subcommand{"synth", "Write the Level II files of a simulated scene (the same bytes every time)",
               set_up_synth},
#ifndef STORMCELLAR_FIRST
    Subcommand{"view", "Open Level II files in a browser, in three dimensions, until Ctrl-C",
               set_up_view},
#endif
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

// The registry of the program that draws the first picture of scripts/demo.
#include <array>

#include "cli/subcommands.h"

namespace stormcellar::cli {

// Each is defined in the file of its subcommand.
Run set_up_frame(CLI::App& command);
Run set_up_synth(CLI::App& command);

namespace {

constexpr std::array registry{
    Subcommand{"frame", "Draw a still picture of Level II files", set_up_frame},
    Subcommand{"synth", "Write the Level II files of a simulated scene", set_up_synth},
};

}  // namespace

std::span<const Subcommand> subcommands() {
    return registry;
}

}  // namespace stormcellar::cli

// cli/shared/commands.h -- the subcommands of `stormcellar`, and what they share.
//
// Each add_*() puts its subcommand and options on the app and gives the function to run when that
// subcommand was chosen. A command parses its arguments, calls the library and prints; nothing
// else. Facts go to stdout (with --json as one JSON document), messages and progress to stderr.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/printable.h"
#include "stormcellar/base/result.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

// Exit status of every command.
enum ExitStatus : int {
    exit_done = 0,
    exit_failed = 1,          // the work failed
    exit_bad_usage = 2,       // options that make no sense
    exit_nothing_matched = 3  // a query with an empty answer
};

struct Command {
    CLI::App* app = nullptr;   // to ask whether it was chosen
    std::function<int()> run;  // gives the exit status
};

// Every subcommand, one line each in cli/main.cpp.
using Commands = std::vector<Command>;

Command add_accuracy(CLI::App& app);
Command add_cache(CLI::App& app);
Command add_catalog(CLI::App& app);
Command add_fetch(CLI::App& app);
Command add_frame(CLI::App& app);
Command add_grid(CLI::App& app);
Command add_info(CLI::App& app);
Command add_loop(CLI::App& app);
Command add_replay(CLI::App& app);
Command add_status(CLI::App& app);
Command add_synth(CLI::App& app);

// Prints "stormcellar: MESSAGE" on stderr, control characters escaped, and gives the exit status
// that fits the code: bad_argument is bad usage, everything else is failed work.
int report_error(const Error& error);

// Prints "stormcellar: note: TEXT" on stderr, control characters escaped: what was done is right,
// but may not be what was meant.
void print_note(const std::string& text);

// "grid" of one, "grids" of any other number.
[[nodiscard]] std::string plural(std::uint64_t count, std::string_view thing);

using ::stormcellar::printable;

}  // namespace stormcellar::cli

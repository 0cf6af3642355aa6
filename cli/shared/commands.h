// cli/shared/commands.h -- code that the subcommands of `stormcellar` share.
//
// Each add_*() adds its subcommand and its options to the app, and returns the function to run if
// that subcommand is chosen. A command only parses its arguments, calls the library and prints.
// Facts go to stdout (with --json as one JSON document), messages and progress to stderr.
//
// Threads   One thread at a time.
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

// The exit status of every command.
enum ExitStatus : int {
    exit_done = 0,
    exit_failed = 1,          // the work failed
    exit_bad_usage = 2,       // invalid options
    exit_nothing_matched = 3  // a query with an empty answer
};

// A function that does the work of a subcommand after its options were parsed. It returns the exit
// status.
using Run = std::function<int()>;

struct Command {
    CLI::App* app = nullptr;  // the subcommand's parser, which knows if it was chosen
    Run run;
};
using Commands = std::vector<Command>;

// Prints "stormcellar: MESSAGE" on stderr, with control characters escaped. Returns the exit status
// for the error: exit_bad_usage for bad_argument, exit_failed for all other codes.
int report_error(const Error& error);

// Prints "stormcellar: note: TEXT" on stderr, with control characters escaped. A note says that the
// work succeeded but may differ from what was intended.
void print_note(const std::string& text);

// Returns the noun for this count, such as "grid" for 1 and "grids" for any other number.
[[nodiscard]] std::string plural(std::uint64_t count, std::string_view thing);

using ::stormcellar::printable;

}  // namespace stormcellar::cli

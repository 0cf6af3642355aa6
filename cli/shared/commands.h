// cli/shared/commands.h -- what the subcommands of `stormcellar` share.
//
// A subcommand is one function, which puts its options on the parser and gives what runs it
// (cli/subcommands.h lists them). It parses its arguments, calls the library and prints; nothing
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

// Does the work of a subcommand whose options were parsed, and gives the exit status.
using Run = std::function<int()>;

struct Command {
    CLI::App* app = nullptr;  // to ask whether it was chosen
    Run run;
};
using Commands = std::vector<Command>;

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

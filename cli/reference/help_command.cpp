// stormcellar help [COMMAND]: prints the help of the program or of a command.
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/reference/reference.h"
#include "cli/reference/wrong_words.h"
#include "cli/shared/commands.h"

namespace stormcellar::cli {
namespace {

struct HelpOptions {
    std::vector<std::string> words;
    bool all = false;
};

int run_help(const HelpOptions& options, const CLI::App& program) {
    const CommandReference reference = reference_of(program);
    const std::string name = fmt::format("{}", fmt::join(options.words, " "));
    const CommandReference* const command = find_command(reference, name);
    if (command == nullptr)
        return report_error({ErrorCode::bad_argument, no_command(name, reference)});
    fmt::print("{}", help_of(*command, options.all ? HelpExtent::all : HelpExtent::usual));
    return exit_done;
}

}  // namespace

Run set_up_help(CLI::App& command) {
    const auto options = std::make_shared<HelpOptions>();
    command.add_option("COMMAND", options->words,
                       "The command. Default: the program, with a list of its commands");
    command.add_flag("--all", options->all, "Show every option, not only the usual ones");
    return [options, program = command.get_parent()] { return run_help(*options, *program); };
}

}  // namespace stormcellar::cli

// stormcellar: the command line. Each subcommand has its own file; see cli/shared/commands.h.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/memory.h"
#include "cache/map_guard.h"
#include "cli/reference/completed_names.h"
#include "cli/reference/reference.h"
#include "cli/reference/wrong_words.h"
#include "cli/shared/commands.h"
#include "cli/subcommands.h"
#include "stormcellar/base/version.h"

namespace stormcellar::cli {
namespace {

// Makes every option and argument refuse an empty text.
void refuse_empty(CLI::App& command) {
    const auto complaint = [](const std::string& value) {
        return value.empty() ? std::string{"must not be empty"} : std::string{};
    };
    for (CLI::Option* option : command.get_options()) {
        if (option->get_expected_max() > 0) option->check(complaint);
    }
    for (CLI::App* inner : command.get_subcommands({}))
        refuse_empty(*inner);
}

// Returns the subcommand that was typed first, if it can run or explain itself alone. To set up all
// commands takes ten times as long as to set up one.
const Subcommand* only_command(int argc, char** argv) {
    const Subcommand* const typed = argc < 2 ? nullptr : find_subcommand(argv[1]);
    return typed != find_subcommand("help") ? typed : nullptr;
}

// Returns the first word if it is no command, because CLI11 would only report that a subcommand is
// missing.
std::optional<std::string> unknown_command(int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-' || find_subcommand(argv[1]) != nullptr) return std::nullopt;
    return argv[1];
}

// Returns the command that was typed, such as "catalog list"; empty if none was typed.
std::string command_typed(const CLI::App& app) {
    std::string words;
    for (const CLI::App* at = &app; at != nullptr;) {
        const auto inner = at->get_subcommands();
        const auto named = std::ranges::find_if(
            inner, [](const CLI::App* one) { return !one->get_name().empty(); });
        at = named == inner.end() ? nullptr : *named;
        if (at != nullptr) words += (words.empty() ? "" : " ") + at->get_name();
    }
    return words;
}

// Prints the requested help or version, or the error. Returns the exit status.
int answer(const CLI::ParseError& error, const CLI::App& app) {
    if (error.get_name() == "CallForVersion") return app.exit(error) == 0 ? exit_done : exit_failed;
    const CommandReference program = reference_of(app);
    const std::string name = command_typed(app);
    const CommandReference* const found = find_command(program, name);
    const CommandReference& command = found == nullptr ? program : *found;
    if (error.get_exit_code() == 0) {
        const bool all = error.get_name() == "CallForAllHelp";
        fmt::print("{}", help_of(command, all ? HelpExtent::all : HelpExtent::usual));
        return exit_done;
    }
    fmt::print(stderr, "stormcellar: {}\nTry 'stormcellar {}--help'.\n",
               printable(reason_of(error, app.remaining(true), command)),
               name.empty() ? "" : name + " ");
    return exit_bad_usage;
}

// Flushes stdout. Returns the status, or a failure if the output could not be written.
int flushed(int status) {
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (!failed) return status;
    fmt::print(stderr, "stormcellar: cannot write to standard output\n");
    return status == exit_done ? exit_failed : status;
}

// Prints the reference, for the hidden option that the build of the package uses
// (cli/reference/reference.h).
int print_reference(const CLI::App& app, const std::string& kind) {
    const std::optional<std::string> text = reference_text(app, kind);
    if (!text) {
        fmt::print(stderr, "stormcellar: --reference takes man, bash, zsh or fish\n");
        return exit_bad_usage;
    }
    fmt::print("{}", *text);
    return exit_done;
}

int run(int argc, char** argv) {
    keep_freed_memory();
    cache::install_map_guard();
    CLI::App app{"Catalogs, grids and draws NEXRAD Level II weather radar volumes."};
    app.name("stormcellar");
    app.set_version_flag("--version", fmt::format("stormcellar {}", software_version));
    app.set_help_all_flag("--help-all", "Print help with all options");
    app.require_subcommand(1);

    Commands commands;
    const Subcommand* const only = only_command(argc, argv);
    for (const Subcommand& subcommand : subcommands()) {
        if (only == nullptr || only == &subcommand)
            commands.push_back(add_subcommand(app, subcommand));
    }
    refuse_empty(app);
    if (argc == 3 && std::string_view{argv[1]} == "--reference")
        return print_reference(app, argv[2]);
    if (argc >= 3 && std::string_view{argv[1]} == "--complete")
        return print_completions(argv[2], {argv + 3, argv + argc});
    if (const auto word = unknown_command(argc, argv)) {
        fmt::print(stderr, "stormcellar: {}\nTry 'stormcellar --help'.\n",
                   printable(no_command(*word, reference_of(app))));
        return exit_bad_usage;
    }

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return answer(error, app);
    }
    for (const Command& command : commands) {
        if (command.app->parsed()) return command.run();
    }
    return exit_bad_usage;
}

}  // namespace
}  // namespace stormcellar::cli

int main(int argc, char** argv) {
    try {
        return stormcellar::cli::flushed(stormcellar::cli::run(argc, argv));
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "stormcellar: this work needs more memory than the machine can give\n");
        return stormcellar::cli::exit_failed;
    } catch (const std::exception& error) {
        fmt::print(stderr, "stormcellar: {}\n", stormcellar::cli::printable(error.what()));
        return stormcellar::cli::exit_failed;
    }
}

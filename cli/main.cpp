// stormcellar: the command line. One subcommand for each file; see cli/shared/commands.h.
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
#include "cli/reference/reference.h"
#include "cli/shared/commands.h"
#include "cli/subcommands.h"
#include "stormcellar/base/version.h"

namespace stormcellar::cli {
namespace {

// No option and no argument may be empty.
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

// CLI11 would only report that a subcommand is missing.
std::optional<std::string> unknown_command(int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-' || find_subcommand(argv[1]) != nullptr) return std::nullopt;
    return argv[1];
}

// Returns "stormcellar catalog list" if the error is in what follows that command.
std::string help_of(const CLI::App& app) {
    std::string words = "stormcellar";
    for (const CLI::App* at = &app; at != nullptr;) {
        const auto inner = at->get_subcommands();
        const auto named = std::ranges::find_if(
            inner, [](const CLI::App* one) { return !one->get_name().empty(); });
        at = named == inner.end() ? nullptr : *named;
        if (at != nullptr) words += " " + at->get_name();
    }
    return words;
}

// What the parser says, as a sentence: "--last: Value 0 not in range 1 to 9" and
// "--last: 1 required INT missing" are none.
std::string sentence_of(const std::string& said) {
    constexpr std::string_view value = ": Value ", range = " not in range ";
    const std::size_t at_value = said.find(value), at_range = said.rfind(range);
    if (at_value < at_range && at_range != std::string::npos) {
        const std::size_t begin = at_value + value.size();
        return fmt::format("{} must be {}, not {}", said.substr(0, at_value),
                           said.substr(at_range + range.size()),
                           said.substr(begin, at_range - begin));
    }
    const std::size_t at_missing = said.find(": 1 required ");
    if (at_missing != std::string::npos && said.ends_with(" missing"))
        return fmt::format("{} needs a value", said.substr(0, at_missing));
    return said;
}

// A misspelled option is also the cause if a required one is missing; CLI11 would report the
// latter.
std::string reason_of(const CLI::ParseError& error, const CLI::App& app) {
    // For "--prodct volume" the option, and not what follows it.
    std::vector<std::string> unknown = app.remaining(true);
    std::stable_partition(unknown.begin(), unknown.end(),
                          [](const std::string& word) { return word.starts_with('-'); });
    const int code = error.get_exit_code();
    const bool may_be_misspelt = code == static_cast<int>(CLI::ExitCodes::RequiredError) ||
                                 code == static_cast<int>(CLI::ExitCodes::ExtrasError);
    if (!may_be_misspelt || unknown.empty()) return sentence_of(error.what());
    const std::string& word = unknown.front();
    return word.starts_with('-') ? fmt::format("there is no option {}", word)
                                 : fmt::format("the argument {} is one too many", word);
}

// Output only counts as done when it was written.
int flushed(int status) {
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (!failed) return status;
    fmt::print(stderr, "stormcellar: cannot write to standard output\n");
    return status == exit_done ? exit_failed : status;
}

// Hidden; used by the build of the package (cli/reference/reference.h).
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
    app.set_version_flag("--version", std::string{software_version});
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::help);

    Commands commands;
    for (const Subcommand& subcommand : subcommands())
        commands.push_back(add_subcommand(app, subcommand));
    refuse_empty(app);
    if (argc == 3 && std::string_view{argv[1]} == "--reference")
        return print_reference(app, argv[2]);
    if (const auto word = unknown_command(argc, argv)) {
        fmt::print(stderr, "stormcellar: there is no command '{}'\nTry 'stormcellar --help'.\n",
                   printable(*word));
        return exit_bad_usage;
    }

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const bool asked_for_help = error.get_exit_code() == 0;
        if (asked_for_help) return app.exit(error) == 0 ? exit_done : exit_failed;
        fmt::print(stderr, "stormcellar: {}\nTry '{} --help'.\n", printable(reason_of(error, app)),
                   help_of(app));
        return exit_bad_usage;
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

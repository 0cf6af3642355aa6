// cli/reference/reference.h -- describes the options of `stormcellar` as help, as a manual page,
// and as completions for shells.
//
// All of these are generated from the parser itself, so they match the program's real options. The
// build of the package calls `stormcellar --reference man|bash|zsh|fish`, which --help does not
// show; packaging/man has the parts of the manual that are not generated. Hidden options (with an
// empty group) are left out. -h,--help and --help-all are not repeated for each command.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/reference/command_guide.h"
#include "cli/reference/value_words.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

struct OptionReference {
    std::vector<std::string> names;    // "-o", "--output"; empty: positional only
    std::string place;                 // "DOMAIN"; empty: named only
    std::string usage;                 // how the position appears in a command line:
                                       // "FILE...|DOMAIN"
    std::string value;                 // "FILE" (value_words.h); empty: a flag
    std::vector<std::string> choices;  // the allowed values; none: any
    std::vector<std::string> offers;   // usual values; the option takes other values, too
    Kept kept = Kept::files;           // where to find the values that are not listed
    std::string range;                 // "1 to 1000000"; empty: none
    std::string initial;               // the default; empty: none, or given in the description
    std::string description;
    std::string group;                   // heading in the help; empty: none
    std::vector<std::string> not_with;   // options that exclude it
    std::vector<std::string> only_with;  // options that it needs
    bool is_whole = false;               // the value is a whole number
    bool is_required = false;
};

struct CommandReference {
    std::string name;  // "catalog get"; empty for the program itself
    std::string description, footer;
    std::vector<CommandExample> examples;
    std::vector<OptionReference> options;
    std::vector<CommandReference> inner;
};

[[nodiscard]] CommandReference reference_of(const CLI::App& app);
// Returns the command of this name, such as "catalog get"; null if the program has none.
[[nodiscard]] const CommandReference* find_command(const CommandReference& program,
                                                   std::string_view name);

// Returns the text about an option in help and manual: its description, range and default, and the
// options that it needs or excludes. Each entry is a sentence with its period.
[[nodiscard]] std::vector<std::string> sentences_of(const OptionReference& option);

enum class HelpExtent { usual, all };
// Returns the text of --help or --help-all. Lines have at most 80 columns, and the text ends with a
// line end.
[[nodiscard]] std::string help_of(const CommandReference& command, HelpExtent extent);

// Returns the manual in the format of man(7), with a heading for each command that can run.
[[nodiscard]] std::string manual_of(const CommandReference& program);
// Return completion scripts, which a user sources or installs where the shell looks for them.
[[nodiscard]] std::string bash_completion_of(const CommandReference& program);
[[nodiscard]] std::string zsh_completion_of(const CommandReference& program);
[[nodiscard]] std::string fish_completion_of(const CommandReference& program);

// Returns the text of this kind (man, bash, zsh or fish), or none for another kind.
[[nodiscard]] std::optional<std::string> reference_text(const CLI::App& app, std::string_view kind);

}  // namespace stormcellar::cli

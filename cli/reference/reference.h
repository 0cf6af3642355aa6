// cli/reference/reference.h -- the options of `stormcellar` as a manual and for shells that
// complete them.
//
// Read from the parser itself, so that they are those that the program has. The package is built
// with `stormcellar --reference man|bash|zsh|fish`, which --help does not show; the pages around
// the manual's part stand in packaging/man. Hidden options (of an empty group) are in none.
// -h,--help is not repeated for each command. Thread contract: pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace stormcellar::cli {

struct OptionReference {
    std::vector<std::string> names;    // "-o", "--output"; none: only by its place
    std::string place;                 // "DOMAIN"; empty: only by name
    std::string value;                 // "TEXT"; empty: a flag
    std::vector<std::string> choices;  // that the value is one of; none: anything
    std::string range;                 // "1 - 1000000"; empty: none
    std::string initial;               // the default; empty: none or said in the description
    std::string description;
    std::string group;  // the heading it stands under; empty: none of its own
    bool is_required = false;
};

struct CommandReference {
    std::string name;  // "catalog get"; of the program itself empty
    std::string description, footer;
    std::vector<OptionReference> options;
    std::vector<CommandReference> inner;
};

[[nodiscard]] CommandReference reference_of(const CLI::App& app);

// Headings and lists of man(7), one heading a command that does something.
[[nodiscard]] std::string manual_of(const CommandReference& program);
// Files to be sourced or put where the shell looks for completions.
[[nodiscard]] std::string bash_completion_of(const CommandReference& program);
[[nodiscard]] std::string zsh_completion_of(const CommandReference& program);
[[nodiscard]] std::string fish_completion_of(const CommandReference& program);

// By the name man, bash, zsh or fish; none for another.
[[nodiscard]] std::optional<std::string> reference_text(const CLI::App& app, std::string_view kind);

}  // namespace stormcellar::cli

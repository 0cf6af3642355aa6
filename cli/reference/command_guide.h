// cli/reference/command_guide.h -- the first part of a command's help: examples and the usual
// options.
//
// Thread contract: the table is constant.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace stormcellar::cli {

struct CommandExample {
    std::string_view line;  // the command line of the example
    std::string_view what;  // a sentence that says what it does
};

struct CommandGuide {
    std::string_view command;  // "catalog get"; empty: the program itself
    std::vector<CommandExample> examples;
    // The usual options, at most ten, in the order of the help. Only --help-all shows the others.
    // An empty list makes all options usual.
    std::vector<std::string_view> usual = {};
};

inline constexpr std::size_t most_usual_options = 10;

[[nodiscard]] const std::vector<CommandGuide>& command_guides();
// Returns the guide to this command, or null if there is none.
[[nodiscard]] const CommandGuide* find_guide(std::string_view command);

}  // namespace stormcellar::cli

// cli/reference/command_guide.h -- the first part of a command's help: examples and usual options.
//
// Thread contract: the table is constant.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace stormcellar::cli {

struct CommandExample {
    std::string_view line;  // as typed
    std::string_view what;  // a sentence
};

struct CommandGuide {
    std::string_view command;  // "catalog get"; empty: the program itself
    std::vector<CommandExample> examples;
    // Usual options, at most ten, in the order of help; other options are only in --help-all. An
    // empty list makes all options usual.
    std::vector<std::string_view> usual = {};
};

inline constexpr std::size_t most_usual_options = 10;

[[nodiscard]] const std::vector<CommandGuide>& command_guides();
// Returns null if there is no guide to this command.
[[nodiscard]] const CommandGuide* find_guide(std::string_view command);

}  // namespace stormcellar::cli

// cli/reference/value_words.h -- names the kind of value that each option takes.
//
// The parser knows only that a value is a text. This table says whether the text is a file, a
// moment or a station, for example. Help, the manual and the completions of shells use it. Thread
// contract: the table is constant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stormcellar::cli {

// The place where completions find values that no list can name.
enum class Kept { nowhere, files, directories, domains, stations, commands };

struct ValueWord {
    std::string_view option;  // "--scene", or the name of an argument: "DOMAIN"
    std::string_view word;    // "FILE"
    Kept kept = Kept::nowhere;
    std::vector<std::string> (*values)() = nullptr;  // values that completions offer; null: none
    std::string_view command = {};                   // "catalog get"; empty: every command
};

// Returns the row of an option, or null if there is none. A row for this command takes precedence
// over a row for all commands.
[[nodiscard]] const ValueWord* find_value_word(std::string_view option, std::string_view command);
[[nodiscard]] std::span<const ValueWord> value_words();

}  // namespace stormcellar::cli

// cli/reference/value_words.h -- what a person reads and types where an option takes a value.
//
// The parser knows that a value is a text; this table knows that it is a file, a moment or a
// station. Help, the manual and the completions of shells take it from here.
// Thread contract: the table is constant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stormcellar::cli {

// Where the values are that no list can name.
enum class Kept { nowhere, files, directories, domains, stations, commands };

struct ValueWord {
    std::string_view option;  // "--scene", or the place of an argument: "DOMAIN"
    std::string_view word;    // "FILE"
    Kept kept = Kept::nowhere;
    std::vector<std::string> (*values)() = nullptr;  // those that completions offer; null: none
    std::string_view command = {};                   // "catalog get"; empty: every command
};

// Null: there is no row. A row of this command goes before one of every command.
[[nodiscard]] const ValueWord* find_value_word(std::string_view option, std::string_view command);
[[nodiscard]] std::span<const ValueWord> value_words();

}  // namespace stormcellar::cli

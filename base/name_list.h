// base/name_list.h -- lists the names in a table for help and messages, and finds a row by its
// name.
//
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace stormcellar {

// Returns the names of all rows in one text: "a, b, c" or, if `before_last` is " or ", "a, b or c".
template <class Rows>
[[nodiscard]] std::string names_in(const Rows& rows, std::string_view between = ", ",
                                   std::string_view before_last = ", ") {
    std::string names;
    std::size_t left = std::size(rows);
    for (const auto& row : rows) {
        if (!names.empty()) names += left == 1 ? before_last : between;
        names += row.name;
        --left;
    }
    return names;
}

// Returns the `key` of the row with this name, or none.
template <class Rows, class Row, class Key>
[[nodiscard]] std::optional<Key> key_named(const Rows& rows, Key Row::*key, std::string_view name) {
    for (const Row& row : rows) {
        if (row.name == name) return row.*key;
    }
    return std::nullopt;
}

// Returns true if each row's `key` is its index in the table, so that values of an enumeration can
// be used as indexes.
template <class Rows, class Key>
[[nodiscard]] constexpr bool is_in_order(const Rows& rows, Key key) {
    for (std::size_t i = 0; i < std::size(rows); ++i) {
        if (static_cast<std::size_t>(rows[i].*key) != i) return false;
    }
    return true;
}

}  // namespace stormcellar

// synth/toml_reader.h -- takes checked values out of a TOML table.
//
// Every key that is read is remembered; finish() refuses those that nobody asked for, so that a
// misspelt key is found. The first error stays and later reads give their fallbacks: a caller may
// read a whole table and check once. Messages name the file, the line and the key, as in
// "storm.toml:12: storm.peak_dbz: not a number".
// Thread contract: one thread.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "base/result.h"

namespace stormcellar::synth {

struct Range {
    double least = 0;
    double largest = 0;
};

// The first error of a document.
class TomlErrors {
  public:
    explicit TomlErrors(std::string file) : file_(std::move(file)) {}
    void report(const toml::source_region& where, std::string_view key, std::string_view reason);
    [[nodiscard]] const std::optional<Error>& first() const { return first_; }

  private:
    std::string file_;
    std::optional<Error> first_;
};

class TomlReader {
  public:
    // `name` stands before the keys in messages; empty for the root.
    TomlReader(const toml::table& table, std::string name, TomlErrors& errors)
        : table_(table), name_(std::move(name)), errors_(errors) {}

    [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
    // Without a fallback the key must be there. Limits count as inside.
    double number(std::string_view key, Range range, std::optional<double> fallback = {});
    int integer(std::string_view key, Range range, std::optional<int> fallback = {});
    std::string text(std::string_view key, std::optional<std::string> fallback = {});
    // Two numbers, as [east, north].
    std::pair<double, double> pair(std::string_view key, Range range,
                                   std::optional<std::pair<double, double>> fallback = {});
    // A table of this name; none (and an error if it is something else, or `required`).
    std::optional<TomlReader> table(std::string_view key, bool required);
    // Tables written as [[key]]; none is an empty row.
    std::vector<TomlReader> tables(std::string_view key);

    // For what a caller finds wrong with a value that it read.
    void refuse(std::string_view key, std::string_view reason);
    // Refuses the keys that were never asked for.
    void finish();

  private:
    [[nodiscard]] const toml::node* find(std::string_view key, bool required);
    [[nodiscard]] double checked(const toml::node& node, std::string_view key, Range range,
                                 double otherwise);
    [[nodiscard]] std::string full_name(std::string_view key) const;

    const toml::table& table_;
    std::string name_;
    TomlErrors& errors_;
    std::set<std::string, std::less<>> asked_;
};

}  // namespace stormcellar::synth

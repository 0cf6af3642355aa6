#include "synth/toml_reader.h"

#include <cmath>

namespace stormcellar::synth {

void TomlErrors::report(const toml::source_region& where, std::string_view key,
                        std::string_view reason) {
    if (first_) return;
    const auto line = where.begin.line;
    const std::string place = line > 0 ? fmt::format("{}:{}", file_, line) : file_;
    first_ =
        Error{ErrorCode::bad_argument, key.empty() ? fmt::format("{}: {}", place, reason)
                                                   : fmt::format("{}: {}: {}", place, key, reason)};
}

std::string TomlReader::full_name(std::string_view key) const {
    return name_.empty() ? std::string{key} : fmt::format("{}.{}", name_, key);
}

void TomlReader::refuse(std::string_view key, std::string_view reason) {
    const toml::node* node = table_.get(key);
    errors_.report(node == nullptr ? table_.source() : node->source(), full_name(key), reason);
}

const toml::node* TomlReader::find(std::string_view key, bool required) {
    asked_.emplace(key);
    const toml::node* node = table_.get(key);
    if (node == nullptr && required) refuse(key, "missing");
    return node;
}

double TomlReader::checked(const toml::node& node, std::string_view key, Range range,
                           double otherwise) {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number || !std::isfinite(*number)) {
        refuse(key, "not a number");
        return otherwise;
    }
    if (*number < range.least || *number > range.largest) {
        refuse(key,
               fmt::format("{} is not between {} and {}", *number, range.least, range.largest));
        return otherwise;
    }
    return *number;
}

double TomlReader::number(std::string_view key, Range range, std::optional<double> fallback) {
    const double otherwise = fallback.value_or(range.least);
    const toml::node* node = find(key, !fallback);
    return node == nullptr ? otherwise : checked(*node, key, range, otherwise);
}

int TomlReader::integer(std::string_view key, Range range, std::optional<int> fallback) {
    const int otherwise = fallback.value_or(static_cast<int>(range.least));
    const toml::node* node = find(key, !fallback);
    if (node == nullptr) return otherwise;
    if (!node->is_integer()) {
        refuse(key, "not a whole number");
        return otherwise;
    }
    return static_cast<int>(checked(*node, key, range, otherwise));
}

std::string TomlReader::text(std::string_view key, std::optional<std::string> fallback) {
    const toml::node* node = find(key, !fallback);
    if (node == nullptr) return fallback.value_or(std::string{});
    const auto text = node->is_string() ? node->value<std::string>() : std::nullopt;
    if (!text) refuse(key, "not a text in quotes");
    return text.value_or(std::string{});
}

std::pair<double, double> TomlReader::pair(std::string_view key, Range range,
                                           std::optional<std::pair<double, double>> fallback) {
    const auto otherwise = fallback.value_or(std::pair{range.least, range.least});
    const toml::node* node = find(key, !fallback);
    if (node == nullptr) return otherwise;
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != 2) {
        refuse(key, "not two numbers, as in [east, north]");
        return otherwise;
    }
    return {checked(*array->get(0), key, range, otherwise.first),
            checked(*array->get(1), key, range, otherwise.second)};
}

std::optional<TomlReader> TomlReader::table(std::string_view key, bool required) {
    const toml::node* node = find(key, required);
    if (node == nullptr) return std::nullopt;
    const toml::table* table = node->as_table();
    if (table == nullptr) {
        refuse(key, fmt::format("not a table, as in [{}]", full_name(key)));
        return std::nullopt;
    }
    return TomlReader(*table, full_name(key), errors_);
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) {
    std::vector<TomlReader> readers;
    const toml::node* node = find(key, false);
    if (node == nullptr) return readers;
    const toml::array* array = node->as_array();
    if (array == nullptr || (!array->empty() && !array->is_homogeneous(toml::node_type::table))) {
        refuse(key, fmt::format("not a list of tables, as in [[{}]]", full_name(key)));
        return readers;
    }
    for (const toml::node& element : *array) {
        readers.emplace_back(*element.as_table(), full_name(key), errors_);
    }
    return readers;
}

void TomlReader::finish() {
    for (const auto& [key, node] : table_) {
        if (!asked_.contains(key.str())) {
            errors_.report(key.source(), full_name(key.str()), "no such setting");
        }
    }
}

}  // namespace stormcellar::synth

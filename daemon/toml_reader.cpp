#include "daemon/toml_reader.h"

#include <cmath>
#include <utility>

#include <toml++/toml.h>

#include "base/file_system.h"
#include "base/printable.h"

namespace stormcellar::daemon {
namespace {

constexpr std::uint64_t largest_file = 1 << 20;

std::string_view kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "text";
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        default:
            return "a date or time";
    }
}

std::string qualified(std::string_view section, std::string_view key) {
    return fmt::format("[{}] {}", printable(section), printable(key));
}

}  // namespace

struct TomlReader::Document {
    toml::table root;

    [[nodiscard]] const toml::table* section(std::string_view name) const {
        const toml::node* node = root.get(name);
        return node == nullptr ? nullptr : node->as_table();
    }
    [[nodiscard]] const toml::node* find(std::string_view name, std::string_view key) const {
        const toml::table* table = section(name);
        return table == nullptr ? nullptr : table->get(key);
    }
};

TomlReader::TomlReader(std::filesystem::path file, std::unique_ptr<Document> document)
    : file_(std::move(file)), document_(std::move(document)) {}
TomlReader::TomlReader(TomlReader&&) noexcept = default;
TomlReader& TomlReader::operator=(TomlReader&&) noexcept = default;
TomlReader::~TomlReader() = default;

Result<TomlReader> TomlReader::open(const std::filesystem::path& file) {
    const Result<std::vector<std::byte>> bytes = read_file(file, largest_file);
    if (!bytes) return pass_on(bytes);
    std::string text(bytes->size(), '\0');
    std::transform(bytes->begin(), bytes->end(), text.begin(),
                   [](std::byte byte) { return static_cast<char>(byte); });
    try {
        return TomlReader(file, std::make_unique<Document>(Document{toml::parse(text)}));
    } catch (const toml::parse_error& error) {
        return fail(ErrorCode::bad_argument, "{}:{}: not valid TOML: {}", file.native(),
                    error.source().begin.line, printable(error.description()));
    }
}

void TomlReader::complain_at(unsigned line, const std::string& what) {
    complaints_.emplace(line, line == 0 ? fmt::format("{}: {}", file_.native(), what)
                                        : fmt::format("{}:{}: {}", file_.native(), line, what));
}

void TomlReader::complain(std::string_view section, std::string_view key, const std::string& why) {
    const toml::node* node = document_->find(section, key);
    if (node == nullptr) node = document_->section(section);
    complain_at(node == nullptr ? 0 : node->source().begin.line,
                fmt::format("{}: {}", qualified(section, key), why));
}

std::optional<std::string> TomlReader::text(std::string_view section, std::string_view key) {
    asked_[std::string{section}].emplace(key);
    const toml::node* node = document_->find(section, key);
    if (node == nullptr) return std::nullopt;
    if (const auto* value = node->as_string()) return value->get();
    complain(section, key, fmt::format("must be text in quotes, is {}", kind_of(*node)));
    return std::nullopt;
}

std::optional<double> TomlReader::number(std::string_view section, std::string_view key,
                                         double least, double most) {
    asked_[std::string{section}].emplace(key);
    const toml::node* node = document_->find(section, key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_number()) {
        complain(section, key, fmt::format("must be a number, is {}", kind_of(*node)));
        return std::nullopt;
    }
    const double value = node->value<double>().value_or(NAN);
    if (!(value >= least && value <= most)) {
        complain(section, key,
                 fmt::format("{} is out of range, must be {} to {}", value, least, most));
        return std::nullopt;
    }
    return value;
}

std::optional<int> TomlReader::whole_number(std::string_view section, std::string_view key,
                                            int least, int most) {
    asked_[std::string{section}].emplace(key);
    const toml::node* node = document_->find(section, key);
    if (node == nullptr) return std::nullopt;
    const auto* value = node->as_integer();
    if (value == nullptr) {
        complain(section, key, fmt::format("must be a whole number, is {}", kind_of(*node)));
        return std::nullopt;
    }
    if (value->get() < least || value->get() > most) {
        complain(section, key,
                 fmt::format("{} is out of range, must be {} to {}", value->get(), least, most));
        return std::nullopt;
    }
    return static_cast<int>(value->get());
}

bool TomlReader::is_array(std::string_view section, std::string_view key) const {
    const toml::node* node = document_->find(section, key);
    return node != nullptr && node->is_array();
}

std::optional<std::vector<double>> TomlReader::numbers(std::string_view section,
                                                       std::string_view key) {
    asked_[std::string{section}].emplace(key);
    const toml::node* node = document_->find(section, key);
    if (node == nullptr) return std::nullopt;
    const toml::array* array = node->as_array();
    if (array == nullptr) {
        complain(section, key, fmt::format("must be an array of numbers, is {}", kind_of(*node)));
        return std::nullopt;
    }
    std::vector<double> values;
    for (const toml::node& element : *array) {
        if (!element.is_number()) {
            complain(section, key,
                     fmt::format("must be an array of numbers, holds {}", kind_of(element)));
            return std::nullopt;
        }
        values.push_back(element.value<double>().value_or(NAN));
    }
    return values;
}

void TomlReader::note_unknown_keys() {
    for (const auto& [section, node] : document_->root) {
        const auto known = asked_.find(section.str());
        const toml::table* table = node.as_table();
        if (known == asked_.end()) {
            complain_at(section.source().begin.line,
                        table == nullptr
                            ? fmt::format("unknown key {}", printable(section.str()))
                            : fmt::format("unknown section [{}]", printable(section.str())));
        } else if (table == nullptr) {
            complain_at(section.source().begin.line,
                        fmt::format("{} must be a section: [{}]", section.str(), section.str()));
        } else {
            for (const auto& [key, value] : *table) {
                if (known->second.contains(key.str())) continue;
                complain_at(key.source().begin.line,
                            fmt::format("unknown key {}", qualified(section.str(), key.str())));
            }
        }
    }
}

Status TomlReader::finish() {
    note_unknown_keys();
    if (complaints_.empty()) return {};
    return fail(ErrorCode::bad_argument, "{}", complaints_.begin()->second);
}

}  // namespace stormcellar::daemon

#include "base/toml_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <toml++/toml.h>

#include "base/floating_point.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/toml_depth.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar {
namespace {

constexpr std::uint64_t largest_file = 1 << 20;

std::string_view kind_of(const toml::node& node) {
    if (node.is_table()) return "a table";
    if (node.is_array()) return "an array";
    if (node.is_string()) return "text";
    if (node.is_number()) return "a number";
    return node.is_boolean() ? "true or false" : "a date or time";
}

double number_of(const toml::node& node) {
    if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
    return node.value<double>().value_or(NAN);
}

bool holds_tables(const toml::node& node) {
    const toml::array* array = node.as_array();
    return array != nullptr && !array->empty() && array->is_homogeneous(toml::node_type::table);
}

}  // namespace

struct TomlFile::Document {
    struct Asked {
        const toml::table* table = nullptr;
        std::string name;  // "storm.hook"; empty for the root
        std::set<std::string, std::less<>> keys;
    };

    enum class About { value, absent_key, unknown_key };
    struct Complaint {
        std::string text;
        About about = About::value;
        std::size_t index = 0;  // of the table
        std::string key{};
    };

    toml::table root;
    std::string file;
    std::vector<Asked> asked;
    std::multimap<unsigned, Complaint> complaints;  // by line

    std::size_t add(const toml::table& table, std::string name) {
        asked.push_back({&table, std::move(name), {}});
        return asked.size() - 1;
    }

    const toml::node* find(std::size_t index, std::string_view key) {
        asked[index].keys.emplace(key);
        return asked[index].table->get(key);
    }

    [[nodiscard]] std::string name_below(std::size_t index, std::string_view key) const {
        const std::string& name = asked[index].name;
        return name.empty() ? printable(key) : fmt::format("{}.{}", name, printable(key));
    }

    // Returns "[storm.hook] width_km", or "width_km" in the root.
    [[nodiscard]] std::string full_name(std::size_t index, std::string_view key) const {
        const std::string& name = asked[index].name;
        return name.empty() ? printable(key) : fmt::format("[{}] {}", name, printable(key));
    }

    void complain_at(unsigned line, const std::string& what, About about, std::size_t index,
                     std::string_view key) {
        auto text = line == 0 ? fmt::format("{}: {}", printable(file), what)
                              : fmt::format("{}:{}: {}", printable(file), line, what);
        complaints.emplace(line, Complaint{std::move(text), about, index, std::string(key)});
    }

    void complain(std::size_t index, std::string_view key, std::string_view why) {
        const toml::node* node = asked[index].table->get(key);
        const About about = node == nullptr ? About::absent_key : About::value;
        if (node == nullptr) node = asked[index].table;
        // The root itself has no line.
        const unsigned line = node == &root ? 0 : node->source().begin.line;
        complain_at(line, fmt::format("{}: {}", full_name(index, key), why), about, index, key);
    }

    void complain_kind(std::size_t index, std::string_view key, std::string_view wanted,
                       const toml::node& node) {
        complain(index, key, fmt::format("must be {}, is {}", wanted, kind_of(node)));
    }

    void note_unknown(std::size_t index, const toml::key& key, const toml::node& node) {
        const std::string name = name_below(index, key.str());
        std::string what = fmt::format("unknown key {}", full_name(index, key.str()));
        if (node.is_table()) what = fmt::format("unknown section [{}]", name);
        if (holds_tables(node)) what = fmt::format("unknown section [[{}]]", name);
        complain_at(key.source().begin.line, what, About::unknown_key, index, key.str());
    }

    void note_all_unknown() {
        for (std::size_t i = 0; i < asked.size(); ++i) {
            for (const auto& [key, node] : *asked[i].table) {
                if (!asked[i].keys.contains(key.str())) note_unknown(i, key, node);
            }
        }
    }

    // Returns the complaint to report. If a key is missing but is present under a misspelled name,
    // returns the complaint about the misspelled name.
    [[nodiscard]] const Complaint& first_complaint() const {
        const Complaint& first = complaints.begin()->second;
        if (first.about != About::absent_key) return first;
        // If the whole section is missing, the root may have the section under a misspelled name,
        // or keys of the section.
        const bool lacks_section = complaints.begin()->first == 0 && first.index != 0;
        for (const auto& [line, other] : complaints) {
            const bool in_root = lacks_section && other.index == 0;
            if (in_root && edit_distance(other.key, asked[first.index].name) <= 2) return other;
            if (other.about != About::unknown_key) continue;
            if (other.index != first.index && !in_root) continue;
            if (edit_distance(other.key, first.key) <= 2) return other;
        }
        return first;
    }
};

TomlFile::TomlFile(std::unique_ptr<Document> document) : document_(std::move(document)) {}
TomlFile::TomlFile(TomlFile&&) noexcept = default;
TomlFile& TomlFile::operator=(TomlFile&&) noexcept = default;
TomlFile::~TomlFile() = default;

Result<TomlFile> TomlFile::open(const std::filesystem::path& file) {
    const auto bytes = read_file(file, largest_file);
    if (!bytes) return pass_on(bytes);
    return parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.native());
}

Result<TomlFile> TomlFile::parse(std::string_view text, std::string name) {
    auto document = std::make_unique<Document>();
    document->file = std::move(name);
    if (const auto line = line_of_deep_key(text)) {
        return fail(ErrorCode::bad_argument, "{}:{}: a key has more than {} parts",
                    printable(document->file), *line, most_key_parts);
    }
    try {
        document->root = toml::parse(text);
    } catch (const toml::parse_error& error) {
        return fail(ErrorCode::bad_argument, "{}:{}: not valid TOML: {}", printable(document->file),
                    error.source().begin.line, printable(error.description()));
    }
    document->add(document->root, "");
    return TomlFile(std::move(document));
}

TomlTable TomlFile::root() {
    return {*document_, 0};
}

Status TomlFile::finish() {
    document_->note_all_unknown();
    if (document_->complaints.empty()) return {};
    return fail(ErrorCode::bad_argument, "{}", document_->first_complaint().text);
}

bool TomlTable::has(std::string_view key) const {
    return document_->asked[index_].table->contains(key);
}

bool TomlTable::is_array(std::string_view key) const {
    const toml::node* node = document_->asked[index_].table->get(key);
    return node != nullptr && node->is_array();
}

bool TomlTable::is_text(std::string_view key) const {
    const toml::node* node = document_->asked[index_].table->get(key);
    return node != nullptr && node->is_string();
}

void TomlTable::leave(std::string_view key) {
    (void)document_->find(index_, key);
}

void TomlTable::complain(std::string_view key, std::string_view why) {
    document_->complain(index_, key, why);
}

std::optional<std::string> TomlTable::text(std::string_view key) {
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return std::nullopt;
    if (const auto* value = node->as_string()) return value->get();
    document_->complain_kind(index_, key, "text in quotes", *node);
    return std::nullopt;
}

std::optional<bool> TomlTable::flag(std::string_view key) {
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return std::nullopt;
    if (const auto* value = node->as_boolean()) return value->get();
    document_->complain_kind(index_, key, "true or false", *node);
    return std::nullopt;
}

std::optional<double> TomlTable::number(std::string_view key, TomlRange range) {
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_number()) {
        document_->complain_kind(index_, key, "a number", *node);
        return std::nullopt;
    }
    const double value = number_of(*node);
    if (is_within(value, range.least, range.most)) return value;
    complain(key,
             fmt::format("{} is out of range, must be {} to {}", value, range.least, range.most));
    return std::nullopt;
}

std::optional<int> TomlTable::whole_number(std::string_view key, TomlRange range) {
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_integer()) {
        document_->complain_kind(index_, key, "a whole number", *node);
        return std::nullopt;
    }
    const auto value = number(key, range);
    return value ? std::optional{static_cast<int>(*value)} : std::nullopt;
}

template <class Value, class Read>
std::optional<std::vector<Value>> TomlTable::array(std::string_view key, std::string_view kind,
                                                   const Read& read) {
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return std::nullopt;
    const toml::array* array = node->as_array();
    if (array == nullptr) {
        document_->complain_kind(index_, key, kind, *node);
        return std::nullopt;
    }
    std::vector<Value> values;
    for (const toml::node& element : *array) {
        std::optional<Value> value = read(element);
        if (!value) {
            complain(key, fmt::format("must be {}, holds {}", kind, kind_of(element)));
            return std::nullopt;
        }
        values.push_back(*std::move(value));
    }
    return values;
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key) {
    return array<double>(key, "an array of numbers", [](const toml::node& element) {
        return element.is_number() ? std::optional{number_of(element)} : std::nullopt;
    });
}

std::optional<std::vector<std::string>> TomlTable::texts(std::string_view key) {
    return array<std::string>(key, "an array of texts", [](const toml::node& element) {
        return element.value_exact<std::string>();
    });
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return std::nullopt;
    const std::string name = document_->name_below(index_, key);
    if (const toml::table* table = node->as_table()) {
        return TomlTable{*document_, document_->add(*table, name)};
    }
    document_->complain_kind(index_, key, fmt::format("a section: [{}]", name), *node);
    return std::nullopt;
}

TomlTable TomlTable::section(std::string_view key) {
    static const toml::table empty;
    if (const auto found = table(key)) return *found;
    return {*document_, document_->add(empty, document_->name_below(index_, key))};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    std::vector<TomlTable> all;
    const toml::node* node = document_->find(index_, key);
    if (node == nullptr) return all;
    const std::string name = document_->name_below(index_, key);
    if (!holds_tables(*node)) {
        document_->complain_kind(index_, key, fmt::format("sections: [[{}]]", name), *node);
        return all;
    }
    for (const toml::node& element : *node->as_array())
        all.push_back({*document_, document_->add(*element.as_table(), name)});
    return all;
}

}  // namespace stormcellar

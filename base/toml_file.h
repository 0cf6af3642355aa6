// base/toml_file.h -- checked reading of a TOML file: configuration, scenes.
//
// Every complaint names the file, the line and the key, as in
// "storm.toml:12: [storm.hook] width_km: must be a number, is text". Reading goes on after a
// complaint; finish() gives the one on the earliest line, and for a key that is missing an unknown
// one of the same table that is like it. Keys and tables that nobody asked for are complaints too,
// so that a misspelt key is not silently its default.
// Errors: not_found, io ... from reading the file; bad_argument for what is in it.
// Thread contract: one thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/number_range.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

using TomlRange = NumberRange;

class TomlTable;

class TomlFile {
  public:
    static Result<TomlFile> open(const std::filesystem::path& file);  // at most 1 MiB
    // `name` stands for the file in messages.
    static Result<TomlFile> parse(std::string_view text, std::string name);
    TomlFile(TomlFile&&) noexcept;
    TomlFile& operator=(TomlFile&&) noexcept;
    TomlFile(const TomlFile&) = delete;
    TomlFile& operator=(const TomlFile&) = delete;
    ~TomlFile();

    [[nodiscard]] TomlTable root();
    // The complaint to mend first, unknown keys included.
    [[nodiscard]] Status finish();

  private:
    friend class TomlTable;
    struct Document;
    explicit TomlFile(std::unique_ptr<Document> document);
    std::unique_ptr<Document> document_;
};

// One table of a file, which must outlive it.
class TomlTable {
  public:
    // Each gives none when the key is absent or, with a complaint noted, not of the kind.
    std::optional<std::string> text(std::string_view key);
    std::optional<bool> flag(std::string_view key);
    std::optional<double> number(std::string_view key, TomlRange range);
    std::optional<int> whole_number(std::string_view key, TomlRange range);
    std::optional<std::vector<double>> numbers(std::string_view key);
    std::optional<std::vector<std::string>> texts(std::string_view key);
    std::optional<TomlTable> table(std::string_view key);  // [key]
    TomlTable section(std::string_view key);               // the same; an absent one is empty
    std::vector<TomlTable> tables(std::string_view key);   // [[key]], in the file's order

    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] bool is_array(std::string_view key) const;
    [[nodiscard]] bool is_text(std::string_view key) const;
    // Notes a complaint about the value of a key (about the table when the key is absent).
    void complain(std::string_view key, std::string_view why);

  private:
    friend class TomlFile;
    TomlTable(TomlFile::Document& document, std::size_t index)
        : document_(&document), index_(index) {}

    TomlFile::Document* document_;
    std::size_t index_;  // of the table in the document's list of those that were asked for
};

}  // namespace stormcellar

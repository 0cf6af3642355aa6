// base/toml_file.h -- reads and checks a TOML file, such as a configuration or a scene.
//
// Every complaint names the file, the line (if it has one) and the key, as in "storm.toml:12:
// [storm.hook] width_km: must be a number, is text". Reading continues after a complaint; finish()
// returns the complaint with the earliest line. If this complaint is about a missing key, and the
// file has an unknown key with a similar name, finish() returns the complaint about the unknown key
// instead. Keys and tables that no code has read are unknown, and each is a complaint, so that a
// misspelled key does not silently leave a default in place.
//
// Threads   One thread at a time.
// Errors    not_found, io and others from reading the file; bad_argument for its content.
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
    // `name` is the file's name in messages.
    static Result<TomlFile> parse(std::string_view text, std::string name);
    TomlFile(TomlFile&&) noexcept;
    TomlFile& operator=(TomlFile&&) noexcept;
    TomlFile(const TomlFile&) = delete;
    TomlFile& operator=(const TomlFile&) = delete;
    ~TomlFile();

    [[nodiscard]] TomlTable root();
    // Returns the complaint to fix first, or ok. Call it after all keys were read.
    [[nodiscard]] Status finish();

  private:
    friend class TomlTable;
    struct Document;
    explicit TomlFile(std::unique_ptr<Document> document);
    std::unique_ptr<Document> document_;
};

// One table of a file. The file must outlive the object.
class TomlTable {
  public:
    // Each of these functions returns none (section() and tables(): an empty result) if the key is
    // absent or, with a complaint, if its value has another type or is out of range.
    std::optional<std::string> text(std::string_view key);
    std::optional<bool> flag(std::string_view key);
    std::optional<double> number(std::string_view key, TomlRange range);
    std::optional<int> whole_number(std::string_view key, TomlRange range);
    std::optional<std::vector<double>> numbers(std::string_view key);
    std::optional<std::vector<std::string>> texts(std::string_view key);
    std::optional<TomlTable> table(std::string_view key);  // [key]
    TomlTable section(std::string_view key);               // [key]; empty if absent
    std::vector<TomlTable> tables(std::string_view key);   // [[key]], in the order of the file

    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] bool is_array(std::string_view key) const;
    [[nodiscard]] bool is_text(std::string_view key) const;
    // Marks the key, and everything below it, as read, so that finish() does not complain about
    // them.
    void leave(std::string_view key);
    // Records a complaint about the value of a key, or about the table if the key is absent.
    void complain(std::string_view key, std::string_view why);

  private:
    friend class TomlFile;
    TomlTable(TomlFile::Document& document, std::size_t index)
        : document_(&document), index_(index) {}

    template <class Value, class Read>
    std::optional<std::vector<Value>> array(std::string_view key, std::string_view kind,
                                            const Read& read);

    TomlFile::Document* document_;
    std::size_t index_;  // index in the document's list of tables that were read
};

}  // namespace stormcellar

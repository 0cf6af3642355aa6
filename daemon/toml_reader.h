// daemon/toml_reader.h -- typed reading of a TOML file of [section] key = value.
//
// Every complaint names the file, the line and the key. Keys that nobody asked for are complaints
// too, so that a misspelt key is not silently its default. The reading goes on after a complaint;
// finish() gives the one on the earliest line.
// Thread contract: one thread.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace stormcellar::daemon {

class TomlReader {
  public:
    // io, not_found ... when it cannot be read; bad_argument when it is not TOML.
    static Result<TomlReader> open(const std::filesystem::path& file);
    TomlReader(TomlReader&&) noexcept;
    TomlReader& operator=(TomlReader&&) noexcept;
    TomlReader(const TomlReader&) = delete;
    TomlReader& operator=(const TomlReader&) = delete;
    ~TomlReader();

    // Each gives none when the key is absent or, with a complaint noted, not of the kind.
    std::optional<std::string> text(std::string_view section, std::string_view key);
    std::optional<double> number(std::string_view section, std::string_view key, double least,
                                 double most);
    std::optional<int> whole_number(std::string_view section, std::string_view key, int least,
                                    int most);
    std::optional<std::vector<double>> numbers(std::string_view section, std::string_view key);
    [[nodiscard]] bool is_array(std::string_view section, std::string_view key) const;

    // Notes a complaint about the value of a key (about the section when the key is absent).
    void complain(std::string_view section, std::string_view key, const std::string& why);
    // The error on the earliest line, unknown keys included.
    Status finish();

  private:
    struct Document;
    TomlReader(std::filesystem::path file, std::unique_ptr<Document> document);
    void note_unknown_keys();
    void complain_at(unsigned line, const std::string& what);

    std::filesystem::path file_;
    std::unique_ptr<Document> document_;
    std::map<std::string, std::set<std::string, std::less<>>, std::less<>> asked_;
    std::multimap<unsigned, std::string> complaints_;  // by line
};

}  // namespace stormcellar::daemon

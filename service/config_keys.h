// service/config_keys.h -- reads configuration keys that several services have.
//
// Threads   One thread at a time for each table.
// Errors    Reported to the table as complaints.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/toml_file.h"

namespace stormcellar {

// Returns true if the text is http:// or https:// with a host, has no query, and has no characters
// that do not belong in a request or a log.
[[nodiscard]] bool is_web_address(std::string_view url);
// Reads an amount of bytes, as a number or as "20 GB". The amount must be at least 1 MB.
void read_bytes(TomlTable& table, std::string_view key, std::uint64_t& bytes);
// Reads a number of `unit` (a second, an hour, a day) and rounds it to the precision of `into`. If
// the key is missing, leaves `into` unchanged.
template <class Duration>
void read_duration(TomlTable& table, std::string_view key, TomlRange range,
                   std::chrono::seconds unit, Duration& into) {
    constexpr auto parts_of_second = static_cast<double>(Duration::period::den);
    if (const auto count = table.number(key, range)) {
        into = Duration{std::llround(*count * static_cast<double>(unit.count()) * parts_of_second)};
    }
}
// Reads a path. A relative path starts at the directory of the configuration `file`.
void read_path_beside(TomlTable& table, std::string_view key, const std::filesystem::path& file,
                      std::filesystem::path& path);
// Reads [log] level.
void read_log_level(TomlTable root, std::string& level);
// Returns the first complaint about the file. Ignores the tables `tables_of_others`, which other
// programs read.
[[nodiscard]] Status finish(TomlFile& toml, std::span<const std::string_view> tables_of_others);

}  // namespace stormcellar

// service/config_keys.h -- keys of the configuration that more than one service has.
//
// Threads   Pure functions, but for the table that they read.
// Errors    Complaints of the table.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/toml_file.h"

namespace stormcellar {

// Returns true for http:// or https:// with a host, without a query and without anything that a
// request or a log should not hold.
[[nodiscard]] bool is_web_address(std::string_view url);
// Reads an amount of bytes, as a number or as "20 GB"; it must be 1 MB at least.
void read_bytes(TomlTable& table, std::string_view key, std::uint64_t& bytes);
// Reads [log] level.
void read_log_level(TomlTable root, std::string& level);

}  // namespace stormcellar

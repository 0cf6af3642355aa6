// catalog/database_uri.h -- writes a path in SQLite's own URI form. Used only inside the catalog
// room.
//
// Threads   Pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::catalog {

// Escapes the path, so that no character of it has a meaning. `query` is "" or begins with '?'.
[[nodiscard]] std::string uri_of(const std::filesystem::path& path, std::string_view query);

}  // namespace stormcellar::catalog

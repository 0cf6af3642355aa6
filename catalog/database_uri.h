// catalog/database_uri.h -- a path as SQLite's own URI form. Inside the catalog room only.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::catalog {

// Escapes the path so that none of its characters has a meaning; `query` is "" or begins with '?'.
// Thread contract: a pure function.
[[nodiscard]] std::string uri_of(const std::filesystem::path& path, std::string_view query);

}  // namespace stormcellar::catalog

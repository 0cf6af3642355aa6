// catalog/database_uri.h -- a path as SQLite's own URI form. Inside the catalog room only.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::catalog {

// So that no character of the path has a meaning; `query` is "" or begins with '?'.
[[nodiscard]] std::string uri_of(const std::filesystem::path& path, std::string_view query);

}  // namespace stormcellar::catalog

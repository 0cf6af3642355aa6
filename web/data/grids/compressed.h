// web/data/grids/compressed.h -- compresses bodies for transfer (Content-Encoding).
//
// The levels were chosen by measurement; docs/web/packed-grid.md has the figures.
//
// Threads   Pure functions.
// Errors    exhausted if there is no memory.
#pragma once

#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "web/http/request.h"

namespace stormcellar::web {

enum class Coding { identity, gzip, zstd };
[[nodiscard]] std::string_view coding_name(Coding coding);  // "" for identity
// Returns zstd if the client accepts it, else gzip if the client accepts that, else identity.
[[nodiscard]] Coding coding_for(const Request& request);

[[nodiscard]] Result<std::string> compressed(std::string_view bytes, Coding coding);
inline constexpr int gzip_level = 4;
inline constexpr int zstd_level = 5;
// Compresses bytes that will be sent often, with the levels `gzip_once_level` and
// `zstd_once_level`.
[[nodiscard]] Result<std::string> compressed_once(std::string_view bytes, Coding coding);
inline constexpr int gzip_once_level = 9;
inline constexpr int zstd_once_level = 19;
// Both compress the bytes at the given level.
[[nodiscard]] Result<std::string> gzipped(std::string_view bytes, int level);
[[nodiscard]] Result<std::string> zstd_packed(std::string_view bytes, int level);

}  // namespace stormcellar::web

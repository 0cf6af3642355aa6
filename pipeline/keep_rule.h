// pipeline/keep_rule.h -- whether the grid of a volume that stands in the cache gives way to
// another.
//
// Inside the pipeline room only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "cache/grid_file.h"

namespace stormcellar::pipeline {

// How the note of a grid of a volume that still grows begins.
inline constexpr std::string_view living_note = "living: ";

// Why the grid at the path must stay: it is whole and the new one is not, its file is newer, or its
// volume has ended and that of the new one still grows. A living grid always gives way to one of a
// volume that has ended. None when it is to be replaced, as one that is damaged, missing or was
// made otherwise always is.
[[nodiscard]] std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                                        const cache::GridDescription& made);

}  // namespace stormcellar::pipeline

// pipeline/keep_rule.h -- whether the grid of a volume that stands in the cache gives way to
// another.
//
// Inside the pipeline room only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cache/grid_file.h"

namespace stormcellar::pipeline {

// Why the grid at the path must stay: it is whole and the new one is not, or its file is newer.
// None when it is to be replaced, as one that is damaged, missing or was made otherwise always is.
[[nodiscard]] std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                                        const cache::GridDescription& made);

}  // namespace stormcellar::pipeline

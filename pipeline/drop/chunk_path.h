// pipeline/drop/chunk_path.h -- which files are the chunks of one volume.
//
// The files of a directory whose names differ in the chunk's number and kind alone
// (stormcellar/level2/chunk_name.h). Thread contract: functions read the directory, no state.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::pipeline {

// A path that is named as a chunk.
struct ChunkPath {
    std::filesystem::path path;
    std::string prefix;  // of the names of all chunks of its volume
    std::string key;     // the same for all chunks of its volume, and for no others
    level2::ChunkName name;

    [[nodiscard]] static std::optional<ChunkPath> of(const std::filesystem::path& path);
};

// All other chunks of its volume in its directory, in the order of their numbers; at most 2,000.
// `beneath`: see base/beneath.h. Errors: those of names_beneath().
[[nodiscard]] Result<std::vector<ChunkPath>> chunks_beside(
    const ChunkPath& chunk, const std::filesystem::path& beneath = {});

}  // namespace stormcellar::pipeline

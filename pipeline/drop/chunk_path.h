// pipeline/drop/chunk_path.h -- which files are the chunks of one volume.
//
// The chunks of a volume are the files of one directory whose names differ only in the chunk's
// number and kind (stormcellar/level2/chunk_name.h). Thread contract: functions without state that
// read the directory.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::pipeline {

// A path whose name is that of a chunk.
struct ChunkPath {
    std::filesystem::path path;
    std::string prefix;  // shared by the names of all chunks of its volume
    std::string key;     // the same for all chunks of its volume, different for all others
    level2::ChunkName name;

    [[nodiscard]] static std::optional<ChunkPath> of(const std::filesystem::path& path);
};

// All other chunks of its volume in its directory, in the order of their numbers; at most 2,000.
// `beneath`: see base/beneath.h. Errors: those of names_beneath().
[[nodiscard]] Result<std::vector<ChunkPath>> chunks_beside(
    const ChunkPath& chunk, const std::filesystem::path& beneath = {});

}  // namespace stormcellar::pipeline

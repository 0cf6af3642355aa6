// pipeline/drop/chunk_path.h -- finds the files that are the chunks of one volume.
//
// The chunks of one volume are the files of one directory whose names differ only in the number and
// the kind of the chunk (stormcellar/level2/chunk_name.h).
//
// Threads   The functions have no state. They read the directory.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::pipeline {

// A path with the name of a chunk.
struct ChunkPath {
    std::filesystem::path path;
    std::string prefix;  // the common start of the names of the volume's chunks
    std::string key;     // the same for all chunks of its volume, and for no other chunks
    level2::ChunkName name;

    // Returns none if the file's name is not a chunk's.
    [[nodiscard]] static std::optional<ChunkPath> of(const std::filesystem::path& path);
};

// Returns the other chunks of the same volume that are in the chunk's directory, at most 2,000, in
// the order of their numbers. `beneath` is the root in base/beneath.h. Errors: those of
// names_beneath().
[[nodiscard]] Result<std::vector<ChunkPath>> chunks_beside(
    const ChunkPath& chunk, const std::filesystem::path& beneath = {});

}  // namespace stormcellar::pipeline

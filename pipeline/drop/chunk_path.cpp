#include "pipeline/drop/chunk_path.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/beneath.h"
#include "pipeline/drop/drop_names.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_siblings = 2000;

}  // namespace

// Makes the key from the whole name without the number and the kind of the chunk.
std::optional<ChunkPath> ChunkPath::of(const fs::path& path) {
    const std::string file = path.filename().string();
    auto placed = level2::place_chunk_name(file);
    if (!placed) return std::nullopt;
    std::string prefix = file.substr(0, placed->number_at);
    std::string key = (path.parent_path() / (prefix + file.substr(placed->behind))).native();
    return ChunkPath{path, std::move(prefix), std::move(key), std::move(placed->name)};
}

Result<std::vector<ChunkPath>> chunks_beside(const ChunkPath& chunk, const fs::path& beneath) {
    const fs::path directory = chunk.path.parent_path();
    const auto names = names_beneath(beneath, directory);
    if (!names) return pass_on(names);
    std::vector<ChunkPath> found;
    for (const std::string& name : *names) {
        if (!name.starts_with(chunk.prefix) || is_temporary_name(name)) continue;
        auto other = ChunkPath::of(directory / name);
        if (other && other->key == chunk.key && other->path != chunk.path &&
            found.size() < most_siblings) {
            found.push_back(std::move(*other));
        }
    }
    std::sort(found.begin(), found.end(), [](const ChunkPath& a, const ChunkPath& b) {
        return std::tie(a.name.number, a.path) < std::tie(b.name.number, b.path);
    });
    return found;
}

}  // namespace stormcellar::pipeline

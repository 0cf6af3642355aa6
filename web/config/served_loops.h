// web/config/served_loops.h -- the loops (animations that stormcellard keeps up to date) that the
// data server sends.
//
// The tables [[loop]] define the loops. stormcellard checks these tables; this reader only skips
// entries that make no sense.
//
// Threads   Plain data and a pure function, which reads files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stormcellar::web {

struct ServedLoop {
    std::string name;
    // Absolute paths. Directories of pictures, which end with a slash, are left out.
    std::vector<std::filesystem::path> files;
    bool operator==(const ServedLoop&) const = default;
};

// Returns the loops of stormcellard.toml. A loop without outputs of its own has the outputs of its
// scene. If the file cannot be read, returns an empty list.
[[nodiscard]] std::vector<ServedLoop> read_served_loops(const std::filesystem::path& file);

}  // namespace stormcellar::web

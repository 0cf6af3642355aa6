// web/config/served_loops.h -- the animations that stormcellard keeps up to date and the data
// server sends.
//
// The tables [[loop]] define the loops. stormcellard checks these tables; this reader skips entries
// that make no sense.
//
// Threads   Plain data and a pure function, which reads files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stormcellar::web {

struct ServedLoop {
    std::string name;
    // Absolute. Directories of pictures, which end with a slash, are left out.
    std::vector<std::filesystem::path> files;
    bool operator==(const ServedLoop&) const = default;
};

// Returns the loops of stormcellard.toml. A loop without outputs of its own has the outputs of its
// scene. A file that cannot be read gives an empty list.
[[nodiscard]] std::vector<ServedLoop> read_served_loops(const std::filesystem::path& file);

}  // namespace stormcellar::web

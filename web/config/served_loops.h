// web/config/served_loops.h -- the animations that stormcellard keeps up to date, as the data
// server gives them out.
//
// They are those of the tables [[loop]]. stormcellard itself checks these tables; here, what makes
// no sense is passed over.
//
// Threads   Plain data and a pure function, which reads files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stormcellar::web {

struct ServedLoop {
    std::string name;
    std::vector<std::filesystem::path> files;  // absolute; directories of pictures are left out
    bool operator==(const ServedLoop&) const = default;
};

// Returns the loops of stormcellard.toml. One without outputs of its own has those of its scene.
// A file that cannot be read has none.
[[nodiscard]] std::vector<ServedLoop> read_served_loops(const std::filesystem::path& file);

}  // namespace stormcellar::web

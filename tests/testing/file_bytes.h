// tests/testing/file_bytes.h -- reads, writes and damages files for tests.
#pragma once

#include <cstddef>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <stdexcept>
#include <string>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::testing {

inline void write_bytes(const fs::path& path, std::span<const std::byte> bytes,
                        std::ios::openmode mode = std::ios::trunc) {
    std::ofstream(path, std::ios::binary | mode)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

inline void append_to(const fs::path& path, std::span<const std::byte> bytes) {
    write_bytes(path, bytes, std::ios::app);
}

// Returns the contents of a file, which must be readable.
inline std::string file_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path.native() + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

// Returns the contents of all files below a directory that have this extension (empty: any), by
// their paths.
inline std::map<std::string, std::string> tree_of(const fs::path& root,
                                                  const std::string& extension = "") {
    std::map<std::string, std::string> tree;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        const fs::path& path = entry.path();
        if (entry.is_regular_file() && (extension.empty() || path.extension() == extension))
            tree[fs::relative(path, root).native()] = file_text(path);
    }
    return tree;
}

inline void alter_last_byte_of(const fs::path& path) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(-1, std::ios::end);
    const char last = static_cast<char>(file.get() ^ 1);
    file.seekp(-1, std::ios::end);
    file.put(last);
}

}  // namespace stormcellar::testing

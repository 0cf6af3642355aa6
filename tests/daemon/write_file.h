// tests/daemon/write_file.h -- writes files, whole or piece by piece.
#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace stormcellar::daemon {

inline void write_file(const std::filesystem::path& path, std::string_view text) {
    std::ofstream(path, std::ios::binary) << text;
}

inline void append_to_file(const std::filesystem::path& path, std::string_view text) {
    std::ofstream(path, std::ios::binary | std::ios::app) << text;
}

}  // namespace stormcellar::daemon

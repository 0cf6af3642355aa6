// tests/archive/archive_maker.h -- makes tar and zip archives for tests.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace stormcellar::archive {

enum class Kind { tar, tar_gz, tar_bz2, tar_compress, tar_xz, tar_zst, zip };

struct Put {
    enum class What { file, symlink, hardlink, directory, fifo };
    std::string name;
    std::vector<std::byte> bytes = {};
    What what = What::file;
    std::string target = {};  // target of a link
};

[[nodiscard]] std::vector<std::byte> make_archive(Kind kind, const std::vector<Put>& puts);
// Packs the bytes with the codec of this kind, but puts no tar or zip around them.
[[nodiscard]] std::vector<std::byte> packed(Kind kind, const std::vector<std::byte>& bytes);
[[nodiscard]] std::vector<std::byte> bytes_of(const std::string& text);

}  // namespace stormcellar::archive

// daemon/watch/file_stamp.h -- tells two states of a raw file apart without reading it. Thread
// contract: functions without state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <sys/stat.h>

namespace stormcellar::daemon {

struct FileStamp {
    std::uint64_t inode = 0;
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0;  // since the epoch
    std::int64_t changed_ns =
        0;  // the same for permissions and owner: shows that an unreadable file was mended

    bool operator==(const FileStamp&) const = default;
};

[[nodiscard]] FileStamp stamp_of(const struct stat& facts);

// What is at a path. Symbolic links are never followed.
enum class Standing { regular, directory, other, missing, unknown };
struct FileFound {
    Standing standing = Standing::missing;
    FileStamp stamp;
    mode_t mode = 0;
};
// A path that may not be examined counts as missing. A path that cannot be examined now, for
// example for want of descriptors, is unknown.
[[nodiscard]] FileFound look_at(const std::filesystem::path& path);
// The same below a directory: what is behind links is missing too (base/beneath.h).
[[nodiscard]] FileFound look_at(const std::filesystem::path& path,
                                const std::filesystem::path& beneath);

}  // namespace stormcellar::daemon

// daemon/watch/file_stamp.h -- detects whether a raw file has changed, without reading it.
//
// Threads   Pure: may be called from any thread.
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
    // Last change of permissions or owner. It makes a file count as changed when the file becomes
    // readable.
    std::int64_t changed_ns = 0;

    bool operator==(const FileStamp&) const = default;
};

[[nodiscard]] FileStamp stamp_of(const struct stat& facts);

// The kind of entry at a path. Symbolic links are not followed.
enum class Standing { regular, directory, other, missing, unknown };
struct FileFound {
    Standing standing = Standing::missing;
    FileStamp stamp;
    mode_t mode = 0;
};
// Returns the entry at the path. If the path may not be examined, the entry is `missing`. If it
// cannot be examined now, for example because descriptors have run out, the entry is `unknown`.
[[nodiscard]] FileFound look_at(const std::filesystem::path& path);
// Returns the entry at the path. If the path leads through a symbolic link below the directory
// `beneath`, the entry is also `missing` (base/beneath.h).
[[nodiscard]] FileFound look_at(const std::filesystem::path& path,
                                const std::filesystem::path& beneath);

}  // namespace stormcellar::daemon

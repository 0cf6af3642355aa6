// stormcellar/base/file_system.h -- the one seam through which files appear.
//
// A file appears by: temporary file in the same directory, write, fsync, rename, fsync of the
// directory. After commit() returns success the file survives a power cut; before that, the final
// name is untouched. Tests replace FileSystem by a double that drops what was not synced, fills up,
// or fails (tests/testing).
// Thread contract: a FileSystem may be used by many threads; an AtomicFile by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar {

class FileSystem {
  public:
    FileSystem() = default;
    FileSystem(const FileSystem&) = delete;
    FileSystem& operator=(const FileSystem&) = delete;
    virtual ~FileSystem() = default;

    // Each returns io, no_space, permission or not_found with the path and the system's reason.
    virtual Result<int> create_exclusive(const std::filesystem::path& path) = 0;
    virtual Status write_at(int descriptor, std::uint64_t offset,
                            std::span<const std::byte> bytes) = 0;
    virtual Status set_size(int descriptor, std::uint64_t size) = 0;
    virtual Status sync(int descriptor) = 0;
    virtual void close(int descriptor) = 0;
    virtual Status rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
    virtual Status sync_directory(const std::filesystem::path& directory) = 0;
    virtual Status remove(const std::filesystem::path& path) = 0;
};

// The operating system's files.
[[nodiscard]] FileSystem& real_file_system();

// Our temporary files start with this, so that others are never touched when leftovers are swept.
inline constexpr std::string_view temporary_prefix = ".stormcellar-tmp-";
[[nodiscard]] std::string own_temporary_prefix();  // of those of this process
// Removes every file of the directory that is named so: what a killed writer left. Only for who
// knows that nobody writes there. No directory is no error; io, permission.
[[nodiscard]] Status remove_temporaries(FileSystem& file_system,
                                        const std::filesystem::path& directory);

// Whether a file can appear at this path: its directory is there and may be written, and nothing
// but a regular file (or a link to one) stands there. For asking before long work.
[[nodiscard]] Status check_target(const std::filesystem::path& path);

// A file that exists under its final name wholly or not at all. Destroyed without commit(), it
// leaves nothing behind. A link is followed; not_a_file where anything but a regular file stands.
class AtomicFile {
  public:
    static Result<AtomicFile> create(FileSystem& file_system, std::filesystem::path final_path);
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    Status append(std::span<const std::byte> bytes);
    Status write_at(std::uint64_t offset, std::span<const std::byte> bytes);
    // Gives the file exactly this size; ranges never written read as zeros and take no space.
    Status set_size(std::uint64_t size);
    Status commit();

    [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_path_; }

  private:
    AtomicFile(FileSystem& file_system, std::filesystem::path final_path,
               std::filesystem::path temporary_path, int descriptor);

    FileSystem* file_system_;
    std::filesystem::path final_path_;
    std::filesystem::path temporary_path_;
    int descriptor_;
    std::uint64_t end_ = 0;
};

// Whole files, for convenience. read_file gives empty for an empty file's bytes as an empty vector
// (not an error), not_a_file for a directory or another thing that is not a regular file (it
// never blocks on a FIFO), and unsupported for a file of more than `limit` bytes.
inline constexpr std::uint64_t default_read_limit = std::uint64_t{1} << 30;
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       std::uint64_t limit = default_read_limit);
// The same of a file that is open; its path is for messages.
[[nodiscard]] Result<std::vector<std::byte>> read_open_file(int descriptor,
                                                            const std::filesystem::path& path,
                                                            std::uint64_t limit);
[[nodiscard]] Status write_file_atomically(FileSystem& file_system,
                                           const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);

}  // namespace stormcellar

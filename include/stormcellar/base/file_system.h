// stormcellar/base/file_system.h -- the one place through which files are created and replaced.
//
// A file appears in these steps: create a temporary file in the same directory, write, fsync,
// rename, fsync the directory. Once commit() has returned success the file survives a power cut;
// before that, the final name is untouched. Tests replace FileSystem by a double that drops what
// was not synced, fills up, or fails (tests/testing).
//
// Units     Offsets and sizes are in bytes.
// Threads   Many threads may use one FileSystem. An AtomicFile may be used by one thread at a time.
// Errors    io, no_space, permission, not_found, not_a_file or unsupported, as each function says;
//           the message has the path and the system's reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/interface.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

class FileSystem : public Interface {
  public:
    // Each function returns io, no_space, permission or not_found, with the path and the system's
    // reason.
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

// Returns the files of the operating system.
[[nodiscard]] FileSystem& real_file_system();

// The names of our temporary files start with this prefix, so that sweeping up leftovers never
// touches other files.
inline constexpr std::string_view temporary_prefix = ".stormcellar-tmp-";
// Returns the prefix of this process, which names the host too: writers on several hosts may share
// a directory.
[[nodiscard]] std::string own_temporary_prefix();
// Removes every file of the directory whose name has the prefix: the leftovers of killed writers.
// Call it only if no other process writes there. A directory that does not exist is not an error.
// Errors: io, permission.
[[nodiscard]] Status remove_temporaries(FileSystem& file_system,
                                        const std::filesystem::path& directory);

// Checks, before long work, whether a file can appear at this path: its directory exists and is
// writable, and the path holds nothing, a regular file, or a link to one.
[[nodiscard]] Status check_target(const std::filesystem::path& path);

// A file that exists under its final name wholly or not at all. If it is destroyed without
// commit(), it leaves nothing behind. A link is followed. create() returns not_a_file if the path
// holds anything but a regular file.
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
    // Gives the file exactly this size. Ranges that were never written read as zeros and take no
    // space.
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

// Read and write whole files. read_file() returns an empty vector for an empty file, not_a_file for
// a directory or anything else that is not a regular file (it never blocks on a FIFO), and
// unsupported for a file of more than `limit` bytes.
inline constexpr std::uint64_t default_read_limit = std::uint64_t{1} << 30;
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       std::uint64_t limit = default_read_limit);
// Reads a file that is already open. The path is used in messages.
[[nodiscard]] Result<std::vector<std::byte>> read_open_file(int descriptor,
                                                            const std::filesystem::path& path,
                                                            std::uint64_t limit);
[[nodiscard]] Status write_file_atomically(FileSystem& file_system,
                                           const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);

}  // namespace stormcellar

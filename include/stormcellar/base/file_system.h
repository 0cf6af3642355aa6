// stormcellar/base/file_system.h -- creates and replaces files so that they are whole even after a
// power cut.
//
// A file appears in these steps: create a temporary file in the same directory, write it, fsync it,
// rename it, fsync the directory. When commit() has returned success, the file survives a power
// cut. If commit() fails, the path still has the old file, or the whole new file if only the sync
// of the directory failed. Tests replace FileSystem by a double that has no space, fails, or loses
// data that were not synced (tests/testing).
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
    // Errors: those of error_code_of() (base/system_error.h), with the system's reason and, if the
    // function knows it, the path.
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

// Returns the file system of the operating system.
[[nodiscard]] FileSystem& real_file_system();

// The prefix of the names of our temporary files. Only files with this prefix are removed as
// leftovers.
inline constexpr std::string_view temporary_prefix = ".stormcellar-tmp-";
// Returns the prefix of this process's temporary files. It contains the host's name, because
// writers on several hosts may share a directory.
[[nodiscard]] std::string own_temporary_prefix();
// Removes the temporary files that killed writers left in the directory. Call it only if no other
// process writes there. A directory that does not exist is not an error. Errors: io, permission.
[[nodiscard]] Status remove_temporaries(FileSystem& file_system,
                                        const std::filesystem::path& directory);

// Checks, before long work, that a file can be created at this path: its directory exists and is
// writable, and the path is free, a regular file, or a link to a regular file.
[[nodiscard]] Status check_target(const std::filesystem::path& path);

// A file that gets its final name only when it is whole. Without commit(), the destructor removes
// the temporary file. If the final path is a link, the file that it leads to is replaced. create()
// returns not_a_file if something other than a regular file is there.
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
    // Sets the size of the file. Ranges that were never written read as zeros and take no space.
    Status set_size(std::uint64_t size);
    // Syncs the file, gives it its final name and syncs the directory.
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

// Reads a whole file. Errors: not_a_file for anything but a regular file (it never blocks on a
// FIFO), unsupported for a file of more than `limit` bytes.
inline constexpr std::uint64_t default_read_limit = std::uint64_t{1} << 30;
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       std::uint64_t limit = default_read_limit);
// Reads a file that is already open. `path` is only for messages.
[[nodiscard]] Result<std::vector<std::byte>> read_open_file(int descriptor,
                                                            const std::filesystem::path& path,
                                                            std::uint64_t limit);
[[nodiscard]] Status write_file_atomically(FileSystem& file_system,
                                           const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);

}  // namespace stormcellar

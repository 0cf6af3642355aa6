// tests/testing/metered_file_system.h -- a file system that measures a directory after every
// operation.
//
// It works on real files and does one operation at a time, for any number of threads. After each
// operation it adds up the blocks of all files below the directory, temporary files included, and
// keeps the largest sum. The file system can also be full. A write beyond `capacity` fails with
// no_space, and removing files makes room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <mutex>

#include "stormcellar/base/file_system.h"

namespace stormcellar::testing {

// Returns the bytes on disk of all regular files below a directory; directories are not counted.
[[nodiscard]] std::uint64_t allocated_bytes(const std::filesystem::path& directory);

class MeteredFileSystem final : public FileSystem {
  public:
    explicit MeteredFileSystem(std::filesystem::path directory)
        : directory_(std::move(directory)) {}

    Result<int> create_exclusive(const std::filesystem::path& path) override;
    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override;
    Status set_size(int descriptor, std::uint64_t size) override;
    Status sync(int descriptor) override;
    void close(int descriptor) override { real_file_system().close(descriptor); }
    Status rename(const std::filesystem::path& from, const std::filesystem::path& to) override;
    Status sync_directory(const std::filesystem::path& directory) override;
    Status remove(const std::filesystem::path& path) override;

    void set_capacity(std::uint64_t bytes);
    [[nodiscard]] std::uint64_t most() const;  // the largest sum so far
    [[nodiscard]] std::uint64_t removals() const;
    void forget();  // resets the counts

  private:
    Status weigh(Status outcome);

    const std::filesystem::path directory_;
    mutable std::mutex mutex_;  // guards all members below, and every operation
    std::uint64_t capacity_ = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t most_ = 0, removals_ = 0;
};

}  // namespace stormcellar::testing

// cache/leftover_watch.h -- finds out if a failed write left a temporary file behind. Used only
// inside the cache room.
//
// AtomicFile removes its temporary file when it fails. If the file system refuses even that, the
// file stays and takes space, which must be counted.
//
// Threads   One thread, for one file.
#pragma once

#include <filesystem>
#include <optional>

#include "stormcellar/base/file_system.h"

namespace stormcellar::cache {

class LeftoverWatch final : public FileSystem {
  public:
    explicit LeftoverWatch(FileSystem& inner) : inner_(inner) {}

    Result<int> create_exclusive(const std::filesystem::path& path) override;
    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override {
        return inner_.write_at(descriptor, offset, bytes);
    }
    Status set_size(int descriptor, std::uint64_t size) override {
        return inner_.set_size(descriptor, size);
    }
    Status sync(int descriptor) override { return inner_.sync(descriptor); }
    void close(int descriptor) override { inner_.close(descriptor); }
    Status rename(const std::filesystem::path& from, const std::filesystem::path& to) override;
    Status sync_directory(const std::filesystem::path& directory) override {
        return inner_.sync_directory(directory);
    }
    Status remove(const std::filesystem::path& path) override;

    // Returns the path of the last file that was created, if it was neither renamed nor removed.
    [[nodiscard]] const std::optional<std::filesystem::path>& leftover() const { return made_; }

  private:
    FileSystem& inner_;
    std::optional<std::filesystem::path> made_;
};

}  // namespace stormcellar::cache

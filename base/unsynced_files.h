// base/unsynced_files.h -- a file system that never syncs, for files that can be made or fetched
// again.
//
// Threads   As the inner file system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "stormcellar/base/file_system.h"

namespace stormcellar {

class UnsyncedFiles final : public FileSystem {
  public:
    explicit UnsyncedFiles(FileSystem& inner) : inner_(inner) {}

    Result<int> create_exclusive(const std::filesystem::path& path) override {
        return inner_.create_exclusive(path);
    }
    Status write_at(int descriptor, std::uint64_t offset,
                    std::span<const std::byte> bytes) override {
        return inner_.write_at(descriptor, offset, bytes);
    }
    Status set_size(int descriptor, std::uint64_t size) override {
        return inner_.set_size(descriptor, size);
    }
    Status sync(int /*descriptor*/) override { return {}; }
    void close(int descriptor) override { inner_.close(descriptor); }
    Status rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
        return inner_.rename(from, to);
    }
    Status sync_directory(const std::filesystem::path& /*directory*/) override { return {}; }
    Status remove(const std::filesystem::path& path) override { return inner_.remove(path); }

  private:
    FileSystem& inner_;
};

}  // namespace stormcellar

// daemon/queue/seen_files.h -- the files that were ingested already, so that a scan offers only new
// or changed files.
//
// It holds some 24 bytes a file: hashes of path and stamp, not the names. Two paths with the same
// 64-bit hash would hide one another; among a million files the odds of that are 1 in 37 million.
// Thread contract: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <unordered_map>

#include "daemon/watch/file_stamp.h"

namespace stormcellar::daemon {

class SeenFiles {
  public:
    [[nodiscard]] bool contains(const std::filesystem::path& path, const FileStamp& stamp) const;
    void add(const std::filesystem::path& path, const FileStamp& stamp);
    void forget(const std::filesystem::path& path);
    void forget_all() { files_.clear(); }
    [[nodiscard]] std::size_t count() const { return files_.size(); }

    // Call these around a complete scan: what is neither found nor added between the two is
    // forgotten.
    void begin_scan() { ++scan_; }
    void found_again(const std::filesystem::path& path);
    void end_scan();

  private:
    struct Seen {
        std::uint64_t stamp_hash = 0;
        std::uint32_t scan = 0;
    };
    std::unordered_map<std::uint64_t, Seen> files_;
    std::uint32_t scan_ = 0;
};

}  // namespace stormcellar::daemon

// daemon/queue/seen_files.h -- remembers which files were already offered, so that a scan offers
// only new and changed files.
//
// Only hashes of the path and the stamp are kept, about 24 bytes for a file. If two paths had the
// same 64-bit hash, one would hide the other. Among a million files, the odds of such a pair are 1
// in 37 million.
//
// Threads   One thread at a time.
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

    // Call begin_scan() before a scan and end_scan() after a complete scan. end_scan() forgets the
    // files that were neither found nor added since begin_scan().
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

// daemon/status/rejected_paths.h -- which files were rejected already, and why. A file that is read
// again and again, for example each time that something is appended, is counted and logged once.
//
// Two reasons are the same if they have the same kind of error and the same text except for
// numbers, which may be a growing size. At most `most` paths are remembered, 40 bytes or so each:
// hashes, not names. Beyond that the oldest are forgotten, and their next rejection counts again.
// Thread contract: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <unordered_map>

#include "pipeline/ingest/ingest.h"

namespace stormcellar::daemon {

class RejectedPaths {
  public:
    explicit RejectedPaths(std::size_t most = 65'536) : most_(most) {}

    // Call it for each file that was read. Returns false if the file was rejected for the same
    // reason the last time. After it was gridded, or was gone, its next rejection counts again.
    bool is_news(const std::filesystem::path& path, const pipeline::IngestOutcome& outcome);
    [[nodiscard]] std::size_t count() const { return reasons_.size(); }

  private:
    std::size_t most_;
    std::unordered_map<std::uint64_t, std::uint64_t> reasons_;  // by the hash of the path
    std::deque<std::uint64_t>
        order_;  // hashes of paths, oldest first; some may be forgotten already
};

}  // namespace stormcellar::daemon

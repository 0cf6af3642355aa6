// daemon/status/rejected_paths.h -- which files were rejected already, and why, so that one that is
// looked at again and again (as each time that something is appended) is counted and logged once.
//
// The same reason is the same kind of error and the same text but for its numbers, which may be a
// size that grows. At most `most` paths are remembered, 40 bytes or so each: hashes, not names; of
// more the oldest are forgotten, and their next rejection is news.
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

    // Of a file that was looked at: false when it was rejected for the same reason as the last
    // time. What was gridded since, or went, is news when it is rejected again.
    bool is_news(const std::filesystem::path& path, const pipeline::IngestOutcome& outcome);
    [[nodiscard]] std::size_t count() const { return reasons_.size(); }

  private:
    std::size_t most_;
    std::unordered_map<std::uint64_t, std::uint64_t> reasons_;  // by path
    std::deque<std::uint64_t> order_;  // of the paths, oldest first; some may be forgotten
};

}  // namespace stormcellar::daemon

// daemon/status/rejected_paths.h -- remembers which files were rejected and why. So if a file is
// ingested each time something is appended, it is counted and logged only once.
//
// Two reasons are the same if the kind of error is the same and the texts differ only in their
// digits, which may show a growing size. At most `most` paths are remembered, as hashes, in about
// 40 bytes each. Beyond that the oldest paths are forgotten; then their next rejection counts as
// new.
//
// Threads   One thread at a time.
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

    // Returns false if the file is rejected for the same reason as the last time, and true for
    // every other outcome. If the file was gridded or vanished in the meantime, its next rejection
    // counts as new.
    bool is_news(const std::filesystem::path& path, const pipeline::IngestOutcome& outcome);
    [[nodiscard]] std::size_t count() const { return reasons_.size(); }

  private:
    std::size_t most_;
    std::unordered_map<std::uint64_t, std::uint64_t> reasons_;  // by path
    std::deque<std::uint64_t> order_;  // hashes of paths, oldest first; also of forgotten paths
};

}  // namespace stormcellar::daemon

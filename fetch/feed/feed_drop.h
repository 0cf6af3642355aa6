// fetch/feed/feed_drop.h -- the directory into which chunks are written, with LDM's names.
//
// A chunk lies at SITE/VOLUME/YYYYMMDD-HHMMSS-NNN-S|I|E, as its key says. It appears there whole,
// or not at all; while it is written it has a temporary name, which stormcellard passes over.
// Nothing waits for the disk, because thirty chunks may come in a second and the bucket has them
// for hours: a power cut may lose the last ones, or leave them empty, and open() removes empty
// ones, so that they are fetched again. The directory itself says what was written; there is no
// other record of it. Volumes are removed when they are older than the limit, and the oldest when
// all of them take more than the limit of bytes. Only files with names of chunks are removed, and
// what a killed writer left. One process writes to a directory.
//
// Units     Sizes are in bytes. A chunk counts for 16 KiB at least, so that a limit of bytes also
//           bounds the number of files.
// Threads   One thread at a time.
// Errors    Those of files.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fetch/feed/chunk_key.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::feed {

struct DropLimits {
    std::chrono::seconds age{0};  // counted from the newest volume, or from now if that is earlier
    std::uint64_t bytes = 0;
};

class FeedDrop {
  public:
    // Creates the directory if it is missing, reads what is in it, and sweeps up.
    static Result<FeedDrop> open(FileSystem& file_system, std::filesystem::path directory,
                                 DropLimits limits, UtcTime now);

    // Returns true if the chunk is there with this size.
    [[nodiscard]] bool has(const ChunkKey& key, std::uint64_t size) const;
    Status write(const ChunkKey& key, std::span<const std::byte> bytes);
    // Returns true if there are more bytes than the limit allows.
    [[nodiscard]] bool is_full() const { return bytes_ > limits_.bytes; }
    // Removes what is beyond the limits, 200 volumes at a time. Returns how many were removed.
    std::size_t prune(UtcTime now);

    // Returns the newest volumes of the station, at most `most`, oldest first.
    [[nodiscard]] std::vector<VolumeId> newest_of(const std::string& station,
                                                  std::size_t most) const;
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    [[nodiscard]] std::size_t volumes() const { return volumes_.size(); }

  private:
    using Volume = std::pair<VolumeId, std::string>;  // of a station; sorted by time
    FeedDrop(FileSystem& file_system, std::filesystem::path directory, DropLimits limits)
        : file_system_(&file_system), directory_(std::move(directory)), limits_(limits) {}
    Status read(UtcTime now);
    Status read_volumes(const std::filesystem::path& directory, const std::string& prefix,
                        UtcTime now);
    void remove(const Volume& volume);

    FileSystem* file_system_;
    std::filesystem::path directory_;
    DropLimits limits_;
    std::map<Volume, std::uint64_t> volumes_;  // and their bytes
    std::uint64_t bytes_ = 0;
};

}  // namespace stormcellar::feed

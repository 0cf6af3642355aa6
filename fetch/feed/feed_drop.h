// fetch/feed/feed_drop.h -- the directory into which the feed writes chunks, under LDM's names.
//
// A chunk has the path of its key: SITE/VOLUME/YYYYMMDD-HHMMSS-NNN-S|I|E. A chunk appears at its
// path complete or not at all; until it is complete, it has a temporary name that stormcellard
// ignores. Writing does not wait for the disk, because thirty chunks may come in a second, and the
// bucket keeps chunks for hours. A power cut may lose the last chunks or leave them empty; open()
// removes empty chunks, so that they are fetched again. Only the directory records which chunks
// were written. prune() removes volumes that are too old, and then the oldest volumes until the
// newer volumes fit the limit of bytes. It removes only files whose names begin as the names of a
// volume's chunks do. open() also removes temporary files of a killed writer. Only one process may
// write to a directory.
//
// Units     Sizes are in bytes. A chunk counts as 16 KiB at least, so that a limit of bytes also
//           limits the number of files.
// Threads   One thread at a time.
// Errors    Those of file operations.
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
    // Age relative to the newest volume, or to the present time if that is earlier.
    std::chrono::seconds age{0};
    std::uint64_t bytes = 0;
};

class FeedDrop {
  public:
    // Creates the directory if it is missing, lists its chunks, and removes leftovers.
    static Result<FeedDrop> open(FileSystem& file_system, std::filesystem::path directory,
                                 DropLimits limits, UtcTime now);

    // Returns true if the directory has the chunk, with this size.
    [[nodiscard]] bool has(const ChunkKey& key, std::uint64_t size) const;
    Status write(const ChunkKey& key, std::span<const std::byte> bytes);
    // Returns true if all chunks together exceed the limit of bytes.
    [[nodiscard]] bool is_full() const { return bytes_ > limits_.bytes; }
    // Removes volumes beyond the limits, at most 200 of them in a call. Returns how many it
    // removed.
    std::size_t prune(UtcTime now);

    // Returns the newest volumes of the station, at most `most`, in ascending order of time.
    [[nodiscard]] std::vector<VolumeId> newest_of(const std::string& station,
                                                  std::size_t most) const;
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    [[nodiscard]] std::size_t volumes() const { return volumes_.size(); }

  private:
    using Volume = std::pair<VolumeId, std::string>;  // a volume and its station; sorted by time
    FeedDrop(FileSystem& file_system, std::filesystem::path directory, DropLimits limits)
        : file_system_(&file_system), directory_(std::move(directory)), limits_(limits) {}
    Status read(UtcTime now);
    Status read_volumes(const std::filesystem::path& directory, const std::string& prefix,
                        UtcTime now);
    void remove(const Volume& volume);

    FileSystem* file_system_;
    std::filesystem::path directory_;
    DropLimits limits_;
    std::map<Volume, std::uint64_t> volumes_;  // size of each volume
    std::uint64_t bytes_ = 0;
};

}  // namespace stormcellar::feed

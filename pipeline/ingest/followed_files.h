// pipeline/ingest/followed_files.h -- the files that are being followed while they grow, and what
// the sites' last volumes left for the next ones.
//
// Bounded for each station and in all (pipeline/ingest/followed.h). The sites' last volumes give
// way first where the disk is concerned, the oldest first: living grids then have less that stands.
// A file that was given up is not followed again, and is read whole when its volume has ended.
// Nothing of this outlives the process. Inside the pipeline room only. Thread contract: all may be
// called by many threads; a file is worked on by one at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "pipeline/ingest/followed.h"
#include "pipeline/ingest/followed_file.h"
#include "pipeline/options/ingest_options.h"

namespace stormcellar::pipeline {

class FollowedFiles {
  public:
    explicit FollowedFiles(FollowedFile::Options options, GrowingLimits limits = {})
        : options_(std::move(options)), limits_(limits), files_(limits) {}

    // Returns null if the file is not followed.
    [[nodiscard]] std::shared_ptr<FollowedFile> find(const std::filesystem::path& path) const;
    // `station`: whose the file says that it is. Null where it cannot be followed: there is no
    // place for it, no descriptor, no room, or it was given up before.
    [[nodiscard]] std::shared_ptr<FollowedFile> begin(const std::filesystem::path& path,
                                                      const std::string& fallback_station,
                                                      const std::string& station);
    // So much more of the file was read: counts what it takes now. False: it was given up, and is
    // not to be read on.
    [[nodiscard]] bool grew(const std::filesystem::path& path, const FollowedFile& file,
                            const std::string& station);
    void forget(const std::filesystem::path& path);
    // It holds more than its share, and must not be followed again.
    void give_up(const std::filesystem::path& path);

    // The volume has ended.
    void keep_last(std::shared_ptr<const ShelvedVolume> volume);
    [[nodiscard]] std::shared_ptr<const ShelvedVolume> last_of(const std::string& station) const;
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] std::uint64_t held_bytes() const;
    // Returns how many files were given up since the last call.
    [[nodiscard]] std::uint64_t take_given_up();

  private:
    void drop_last_beyond_limits();

    FollowedFile::Options options_;
    GrowingLimits limits_;
    mutable std::mutex mutex_;  // guards the members below
    Followed<std::filesystem::path, FollowedFile> files_;
    std::map<std::string, std::shared_ptr<const ShelvedVolume>> last_;
};

}  // namespace stormcellar::pipeline

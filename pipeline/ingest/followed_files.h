// pipeline/ingest/followed_files.h -- the files that are followed while they grow. Also keeps the
// sweeps of each site's last volume, which the living grids of the next volume show.
//
// The number and size of files are limited for each station and in total
// (pipeline/ingest/followed.h). Beyond the limit of disk space, the last volumes of sites are
// dropped, the oldest first; living grids then show fewer old sweeps. A file that was given up is
// not followed again; it is read whole when its volume has ended. Nothing outlives the process.
// Inside the pipeline room only. Thread contract: many threads may call all functions; one thread
// at a time works on a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "pipeline/ingest/followed.h"
#include "pipeline/ingest/followed_file.h"
#include "pipeline/options/ingest_options.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pipeline {

class FollowedFiles {
  public:
    explicit FollowedFiles(FollowedFile::Options options, GrowingLimits limits = {})
        : options_(std::move(options)), limits_(limits), files_(limits) {}

    // Returns the file if it is followed, else null.
    [[nodiscard]] std::shared_ptr<FollowedFile> find(const std::filesystem::path& path) const;
    // Begins to follow a file. `station` is the station in the file's header. Returns null if the
    // file cannot be followed because there is no place, descriptor or room for it, or because it
    // was given up before.
    [[nodiscard]] std::shared_ptr<FollowedFile> begin(const std::filesystem::path& path,
                                                      const std::string& fallback_station,
                                                      const std::string& station);
    // Notes how much memory and disk space the file holds now. Returns false if the file is no
    // longer followed; do not read on then.
    [[nodiscard]] bool grew(const std::filesystem::path& path, const FollowedFile& file,
                            const std::string& station);
    void forget(const std::filesystem::path& path);
    // Gives up a file. It is not followed again.
    void give_up(const std::filesystem::path& path);

    // Keeps the sweeps of a volume that has ended, for the site's next volume. Does not keep them
    // if a later volume is kept already, or if the volume begins more than 10 minutes in the
    // future.
    void keep_last(std::shared_ptr<const ShelvedVolume> volume);
    [[nodiscard]] std::shared_ptr<const ShelvedVolume> last_of(const std::string& station) const;
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] std::uint64_t held_bytes() const;
    // Returns how many files were given up since the last call.
    [[nodiscard]] std::uint64_t take_given_up();

  private:
    void drop_last_beyond_limits() STORMCELLAR_REQUIRES(mutex_);

    FollowedFile::Options options_;
    GrowingLimits limits_;
    mutable Mutex mutex_;
    Followed<std::filesystem::path, FollowedFile> files_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, std::shared_ptr<const ShelvedVolume>> last_
        STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline

// pipeline/living_files.h -- the files that are being followed while they grow, and what the sites'
// last volumes left for the next ones.
//
// Bounded: at most so many files, bytes held and bytes put aside. Beyond these bytes the sites'
// last volumes go first, the oldest first: living grids then have less that stands. Then the file
// that has not grown for longest is given up, and read whole when its volume has ended. Nothing of
// this outlives the process. Inside the pipeline room only. Thread contract: all may be called by
// many threads; a file is worked on by one at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "pipeline/ingest_options.h"
#include "pipeline/living_file.h"

namespace stormcellar::pipeline {

struct LivingLimits {
    std::size_t files = 320;  // each has a descriptor, and each site's last volume
    std::uint64_t held_bytes = std::uint64_t{384} << 20;
    std::uint64_t shelf_bytes = most_put_aside_bytes;
};

class LivingFiles {
  public:
    explicit LivingFiles(LivingFile::Options options, LivingLimits limits = {})
        : options_(std::move(options)), limits_(limits) {}

    // Null where the file is not followed.
    [[nodiscard]] std::shared_ptr<LivingFile> find(const std::filesystem::path& path);
    // Null where it cannot be followed: no descriptors, no room.
    [[nodiscard]] std::shared_ptr<LivingFile> begin(const std::filesystem::path& path,
                                                    const std::string& fallback_station);
    // The file has grown: counts what it takes now.
    void grew(const std::filesystem::path& path, const LivingFile& file);
    void forget(const std::filesystem::path& path);

    // The volume has ended.
    void keep_last(std::shared_ptr<const KeptVolume> volume);
    [[nodiscard]] std::shared_ptr<const KeptVolume> last_of(const std::string& station) const;
    [[nodiscard]] std::size_t count() const;
    // How many files were given up since the last call.
    [[nodiscard]] std::uint64_t take_given_up();

  private:
    struct Followed {
        std::shared_ptr<LivingFile> file;
        std::uint64_t turn = 0;
        std::uint64_t held_bytes = 0, shelf_bytes = 0;
    };
    void give_up_beyond_limits(const std::filesystem::path& but);
    void drop_last_beyond_limits();

    LivingFile::Options options_;
    LivingLimits limits_;
    mutable std::mutex mutex_;  // guards what follows
    std::uint64_t next_turn_ = 0, given_up_ = 0;
    std::map<std::filesystem::path, Followed> files_;
    std::map<std::string, std::shared_ptr<const KeptVolume>> last_;
};

}  // namespace stormcellar::pipeline

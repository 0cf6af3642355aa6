// fetch/pull/pulled_grids.h -- the directory of grids that were pulled from one machine.
//
// The directory has the layout of a cache (stormcellar/cache/grid_name.h). A grid gets its name
// only after all of its bytes were checked: it must be a grid file of the requested station, moment
// and time, each brick must have the right checksum, and the tag must be the one that the server
// named. Until then the grid has a temporary name beside the domains. Directories are made only for
// grids that are kept. open() removes the leftovers of a killed program. Only one process may write
// to a directory.
//
// Units     Sizes are in bytes on disk.
// Threads   One thread at a time.
// Errors    Those of file operations; corrupt, truncated and unsupported if a grid fails the check.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::pull {

struct PulledLimits {
    std::uint64_t bytes = 0;
    std::chrono::seconds age{0};
    // Limit of the number of grids. Each grid, however small, takes a file and some memory. For a
    // mosaic, all radars of a nation make some 60,000 grids of one moment in a day.
    std::size_t grids = 100'000;
};

class PulledGrids {
  public:
    // Creates the directory if it is missing, and lists its grids.
    static Result<PulledGrids> open(FileSystem& file_system, std::filesystem::path directory,
                                    PulledLimits limits);

    [[nodiscard]] bool has(const cache::GridName& name) const { return grids_.contains(name); }
    // Returns the entity tag of the grid in the directory. Returns an empty text if there is no
    // such grid or its tag cannot be read.
    [[nodiscard]] std::string tag_of(const cache::GridName& name);
    // A grid that is being received.
    class Incoming {
      public:
        Status append(std::span<const std::byte> bytes) { return file_.append(bytes); }

      private:
        friend class PulledGrids;
        Incoming(cache::GridName name, AtomicFile file)
            : name_(std::move(name)), file_(std::move(file)) {}
        cache::GridName name_;
        AtomicFile file_;
    };
    [[nodiscard]] Result<Incoming> begin(const cache::GridName& name);
    // Checks the grid and gives it its final name. `tag` is the tag that the server named.
    Status keep(Incoming incoming, const std::string& tag);

    // Removes grids that are too old, and then the oldest grids until the limits of bytes and of
    // grids are met. Returns how many it removed.
    std::size_t prune(UtcTime now);

    [[nodiscard]] std::size_t count() const { return grids_.size(); }
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    [[nodiscard]] std::optional<UtcTime> newest() const;

  private:
    struct Known {
        std::uint64_t bytes = 0;
        std::string tag;  // empty: unknown
    };
    PulledGrids(FileSystem& file_system, std::filesystem::path directory, PulledLimits limits)
        : file_system_(&file_system), directory_(std::move(directory)), limits_(limits) {}
    [[nodiscard]] std::filesystem::path path_of(const cache::GridName& name) const {
        return directory_ / cache::relative_path(name);
    }
    [[nodiscard]] std::filesystem::path incoming() const { return directory_ / ".incoming"; }
    void remove_empty_above(const std::filesystem::path& path) const;
    Status give_name(Incoming& incoming);
    void remember(const cache::GridName& name, std::string tag);
    void remove(const cache::GridName& name);

    FileSystem* file_system_;
    std::filesystem::path directory_;
    PulledLimits limits_;
    std::map<cache::GridName, Known> grids_;
    std::uint64_t bytes_ = 0;
};

}  // namespace stormcellar::pull

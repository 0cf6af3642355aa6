// cache/store.h -- the directory of grid files.
//
// Layout: CACHE/DOMAIN/MOMENT/YYYYMMDD/DOMAIN_MOMENT_YYYYMMDD_HHMMSS_mmm.scg, the time being the
// grid's. There is no index: the names are the index, so nothing can disagree with the files. The
// default domain of a station is its ICAO. A grid committed again for the same time replaces the
// old one; a reader keeps the file that it has open. Symbolic links inside the store are not
// followed, and whatever has not such a name at such a place is not ours: never listed or touched.
// Times are from 1970 to 9999.
// Thread contract: one Store may be used by many threads; many processes may read, one writes.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_system.h"
#include "base/result.h"
#include "base/utc_time.h"
#include "cache/grid_file.h"

namespace stormcellar::cache {

struct StoreEntry {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
    std::filesystem::path path;
    std::uint64_t bytes_on_disk = 0;
};

class Store {
  public:
    // Creates the directory when it is missing. sweep_temporary: remove leftovers of a killed
    // writer; only the one writer (the daemon) may ask for it.
    static Result<Store> open_for_writing(FileSystem& file_system, std::filesystem::path directory,
                                          bool sweep_temporary);
    // not_found when the directory does not exist.
    static Result<Store> open_for_reading(std::filesystem::path directory);

    // The path at which the grid now stands. bad_argument for a domain name that is not
    // [A-Za-z0-9][A-Za-z0-9_-]{0,63}, for a store that was opened for reading, and as
    // write_grid_file. On success the grid survives a power cut, new directories included.
    Result<std::filesystem::path> commit(const std::string& domain,
                                         const GridDescription& description,
                                         const grid::BrickView& view) const;

    // Where a grid of this name stands or would stand. bad_argument as commit.
    [[nodiscard]] Result<std::filesystem::path> path_of(const std::string& domain,
                                                        level2::Moment moment, UtcTime time) const;

    // Sorted. A directory is a domain when it holds a moment's directory.
    [[nodiscard]] Result<std::vector<std::string>> domains() const;
    // Sorted by time; from and to are inclusive, none: open. Empty when nothing matches.
    [[nodiscard]] Result<std::vector<StoreEntry>> list(const std::string& domain,
                                                       level2::Moment moment,
                                                       std::optional<UtcTime> from,
                                                       std::optional<UtcTime> to) const;
    [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }

  private:
    struct DurableDirectories;
    Store(FileSystem* file_system, std::filesystem::path directory);
    Status make_directory(const std::filesystem::path& directory) const;

    FileSystem* file_system_;  // null: opened for reading
    std::filesystem::path directory_;
    // Those whose own names are known to be on disk; shared by copies of a store.
    std::shared_ptr<DurableDirectories> durable_;
};

// Whether a name may stand for a domain: [A-Za-z0-9][A-Za-z0-9_-]{0,63}.
[[nodiscard]] bool is_domain_name(std::string_view name);

}  // namespace stormcellar::cache

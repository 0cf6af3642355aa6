// cache/store.h -- the directory of grid files.
//
// Layout: CACHE/DOMAIN/MOMENT/YYYYMMDD/DOMAIN_MOMENT_YYYYMMDD_HHMMSS_mmm.scg, the time being the
// grid's. There is no index: the names are the index, so nothing can disagree with the files. The
// default domain of a station is its ICAO. A grid committed again for the same time replaces the
// old one; a reader keeps the file that it has open.
// Thread contract: one Store may be used by many threads; many processes may read, one writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
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
    // [A-Za-z0-9][A-Za-z0-9_-]{0,63}.
    Result<std::filesystem::path> commit(const std::string& domain,
                                         const GridDescription& description,
                                         const grid::BrickView& view) const;

    [[nodiscard]] Result<std::vector<std::string>> domains() const;  // sorted
    // Sorted by time; from and to are inclusive, none: open. Empty when nothing matches.
    [[nodiscard]] Result<std::vector<StoreEntry>> list(const std::string& domain,
                                                       level2::Moment moment,
                                                       std::optional<UtcTime> from,
                                                       std::optional<UtcTime> to) const;
    [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }

  private:
    Store(FileSystem& file_system, std::filesystem::path directory);
    FileSystem* file_system_;
    std::filesystem::path directory_;
};

}  // namespace stormcellar::cache

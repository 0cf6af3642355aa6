// bench/made_archive.h -- a large catalog and a large cache that nobody had to receive.
//
// The catalog has, for each of the first NEXRAD stations of the table, volumes that start every
// five minutes from 2024-06-01 on, as rows of files that were read to their end. One more station
// has as many rows, those of the chunks of its volumes. There are no such files: lists never look
// at them. The cache has grids of REF and VEL of the newest of these
// volumes. All are hard links to a few files of one small grid, since the names are what a list
// needs.
//
// Threads   One thread at a time.
// Errors    Those of CatalogWriter and StoreWriter; io if links cannot be made.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

struct ArchiveSize {
    std::size_t stations = 10;
    std::size_t volumes_of_a_station = 100'000;
    std::size_t grids = 100'000;  // of all stations
    bool operator==(const ArchiveSize&) const = default;
};

class MadeArchive {
  public:
    // Makes the archive in a directory, unless one of this size is there.
    static Result<MadeArchive> make(const std::filesystem::path& directory, ArchiveSize size);

    [[nodiscard]] std::filesystem::path catalog() const { return directory_ / "state/catalog"; }
    [[nodiscard]] std::filesystem::path cache() const { return directory_ / "cache"; }
    [[nodiscard]] std::filesystem::path drop() const { return directory_ / "drop"; }
    // Those whose volumes are one file each.
    [[nodiscard]] const std::vector<std::string>& stations() const { return stations_; }
    [[nodiscard]] const std::string& station_of_chunks() const { return station_of_chunks_; }
    // Counts its volumes, which start when the others do.
    [[nodiscard]] std::size_t volumes_of_chunks() const;
    [[nodiscard]] std::size_t grids_of_a_moment() const;
    [[nodiscard]] UtcTime start_of(std::size_t volume) const;

    static constexpr std::size_t chunks_of_a_volume = 55;
    static constexpr level2::Moment moments[] = {level2::Moment::ref, level2::Moment::vel};

  private:
    MadeArchive(std::filesystem::path directory, ArchiveSize size);
    [[nodiscard]] Status fill_catalog() const;
    [[nodiscard]] Status fill_with_chunks(catalog::CatalogWriter& writer) const;
    [[nodiscard]] Status fill_cache() const;

    std::filesystem::path directory_;
    ArchiveSize size_;
    std::vector<std::string> stations_;
    std::string station_of_chunks_;
};

}  // namespace stormcellar::bench

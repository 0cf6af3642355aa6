// bench/mosaic_feed.h -- five hours of Level II files of up to 100 sites, for bench_mosaic.
//
// Sites     The first N by ICAO of the WSR-88Ds between 105 and 67 degrees west and 24 and 49.5
//           north. The order is alphabetical, so ten sites cover as large an area as a hundred.
// Volumes   There are ten kinds of volumes: real volumes of the data directory, and simulated
//           storms. The sites take the kinds in turn. Each volume is re-stamped (bench/restamp.h),
//           so that every radial has the site's name and position, and a time of its own.
//           level2::encode() writes it. The volumes of a site start 5 (simulated), 6 or 10 minutes
//           apart, the duration of their patterns. No two sites start together.
// On disk   FeedFiles::first_hour: the files of the first hour, different for each site and start.
//           Later hours use the same files: when a file is read for hour h, the times of the
//           decoded volume are moved by h hours (`moved`). So five hours are read, decompressed,
//           decoded, gridded and merged; only the compression of 27 GB and disk space are saved.
//           FeedFiles::every_hour: the files of all hours, 3.5 GB for 100 sites, for programs that
//           cannot move times.
// Threads   Plain data and pure functions; make_feed() starts its own threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

inline constexpr std::chrono::hours feed_length{5};
inline constexpr int most_sites = 100;
[[nodiscard]] UtcTime feed_start();

enum class FeedFiles { first_hour, every_hour };

struct FeedVolume {
    int site = 0;   // index of the site
    UtcTime start;  // when it was sent
    std::filesystem::path file;
    std::chrono::hours moved{0};  // by which the times of the file must be moved
};

// Returns a volume that is not re-stamped yet. A name such as "simulated-3" means a simulated
// volume; any other name is a real volume below `data`.
[[nodiscard]] Result<level2::Volume> feed_volume(const std::string& name,
                                                 const std::filesystem::path& data);

[[nodiscard]] std::vector<Station> feed_sites(int count);
// Returns the volumes of the first `hours`, ordered by start, then by site. `sites` is 1 to
// most_sites.
[[nodiscard]] std::vector<FeedVolume> feed_of(int sites, const std::filesystem::path& directory,
                                              std::chrono::hours hours = feed_length,
                                              FeedFiles files = FeedFiles::first_hour);
// Returns a grid of 256 x 256 columns over the box of the sites' positions and their reach (460
// km), with 128 levels from 125 m to 16 km. For 100 sites, cells are some 15 km wide.
[[nodiscard]] grid::GridSpec feed_domain(int sites);

// Sizes of files, counted over their LDM records.
struct FeedSize {
    std::uint64_t compressed = 0, uncompressed = 0;
    std::uint64_t dense = 0;  // uncompressed bytes of files that expand at most 8 times

    [[nodiscard]] double expansion() const {
        return static_cast<double>(uncompressed) / static_cast<double>(compressed);
    }
    [[nodiscard]] double dense_part() const {
        return static_cast<double>(dense) / static_cast<double>(uncompressed);
    }
    void add(std::uint64_t compressed_bytes, std::uint64_t uncompressed_bytes);
};

// Writes the missing files of the feed. `data` is the directory of the real volumes. Errors: a real
// volume is missing or cannot be read; those of encode() and of writing.
[[nodiscard]] Status make_feed(int sites, const std::filesystem::path& data,
                               const std::filesystem::path& directory, int threads,
                               std::chrono::hours hours = std::chrono::hours{1});

}  // namespace stormcellar::bench

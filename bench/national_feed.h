// bench/national_feed.h -- the heaviest national hour of Level II: 160 sites, 13.8 GB an hour in
// some 33 chunks a second (docs/performance.md has the figures of the real one).
//
// Sites    the first 160 WSR-88Ds by ICAO; fewer send as much each.
// Volumes  each site sends one of three real volumes again and again: six of eight a storm with
//          94 chunks and 11.6 MB (KLOT, 2021, with MRLE), one KLBB 2016 (46, 4.0 MB), one KLOT
//          2026 in clear air (55, 3.1 MB). All take `period`, from which the rate follows, and
//          sites begin one after the other, evenly.
// On disk  a file for each site and hour: the real volume's records with the site's name, position
//          and times, compressed again (bench/stamped_records.h). Within the hour, volumes of a
//          site differ by the time in their headers alone: that in the radials is up to 40 minutes
//          off, and gates are the same. Nothing that reads, decompresses, decodes, grids or stores
//          them can save anything by that.
// Threads  plain data; make() uses threads of its own.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::bench {

inline constexpr int national_sites = 160;
inline constexpr double heaviest_hour_bytes = 13.8e9;

struct NationalFile {
    std::filesystem::path path;
    std::uint64_t bytes = 0;
    std::vector<std::uint64_t> ends;  // of its chunks, rising
};

struct NationalSite {
    Station station;
    int kind = 0;
    double first_start_s = 0;         // of its volume 0 on the feed's clock: not after 0
    std::vector<NationalFile> hours;  // what it sends in each
};

class NationalFeed {
  public:
    // Writes the files that are not there yet. Errors: real volumes that are not there, no space.
    [[nodiscard]] static Result<NationalFeed> make(int sites, int hours,
                                                   const std::filesystem::path& data,
                                                   const std::filesystem::path& directory,
                                                   int threads);

    [[nodiscard]] const std::vector<NationalSite>& sites() const { return sites_; }
    [[nodiscard]] double period_s() const { return period_s_; }
    [[nodiscard]] std::uint64_t bytes_on_disk() const;
    [[nodiscard]] double message_bytes_per_byte() const { return expansion_; }
    [[nodiscard]] double chunks_a_second() const;

    // Of a site's volume, from 0.
    [[nodiscard]] UtcTime start_of(const NationalSite& site, int volume) const;
    [[nodiscard]] const NationalFile& file_of(const NationalSite& site, int volume) const;

  private:
    std::vector<NationalSite> sites_;
    double period_s_ = 0;
    double expansion_ = 0;
};

[[nodiscard]] UtcTime national_start();  // the feed's clock at 0

}  // namespace stormcellar::bench

// bench/national_feed.h -- the heaviest national hour of Level II: 160 sites, 13.8 GB an hour in
// some 33 chunks a second.
//
// Sites     The first 160 WSR-88Ds by ICAO. With fewer sites, each site still sends the same
//           amount.
// Volumes   Each site sends one of three real volumes again and again. Of every eight sites, six
//           send a storm with 94 chunks and 11.6 MB (KLOT, 2021, with MRLE), one sends KLBB 2016
//           (46 chunks, 4.0 MB), and one sends KLOT 2026 in clear air (55 chunks, 3.1 MB). Every
//           volume takes `period_s`, which is chosen to give the rate. The starts of the sites are
//           spread evenly over this period.
// On disk   A file for each site and hour: the records of the real volume with the site's name,
//           position and times, compressed again (bench/restamp.h). Within the hour, volumes of a
//           site differ only in the time in their headers. So times of radials are up to 40 minutes
//           off, and all volumes have the same gates. The daemon takes as long to read, decompress,
//           decode, grid and store such volumes as it takes for real files. synth/replay.h plays
//           the files.
// Threads   Plain data; make() starts its own threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/moment.h"
#include "synth/replay.h"

namespace stormcellar::bench {

inline constexpr int national_sites = 160;
inline constexpr double heaviest_hour_bytes = 13.8e9;

struct NationalSite {
    Station station;
    int kind = 0;
    double first_start_s = 0;  // start of volume 0 on the feed's clock, at most 0
    std::uint64_t bytes = 0;   // size of a volume
    std::size_t chunks = 0;
    std::vector<std::filesystem::path> hours;  // file for each hour
};

// A volume that a site sends.
struct NationalVolume {
    std::size_t site = 0;
    int number = 0;  // number among the site's volumes, from 0
    UtcTime start;
    std::string grid;  // the name of the file of its grid of the given moment
};

class NationalFeed {
  public:
    // Writes the files that are missing. Errors: real volumes that do not exist, no space.
    [[nodiscard]] static Result<NationalFeed> make(int sites, int hours,
                                                   const std::filesystem::path& data,
                                                   const std::filesystem::path& directory,
                                                   int threads);

    [[nodiscard]] const std::vector<NationalSite>& sites() const { return sites_; }
    [[nodiscard]] double period_s() const { return period_s_; }
    [[nodiscard]] double message_bytes_per_byte() const { return expansion_; }
    [[nodiscard]] double chunks_a_second() const;

    // Returns the bytes that the feed sends in a second of its clock.
    [[nodiscard]] double bytes_a_second() const;
    // Returns the seconds from the earliest start of a site to 0 on the feed's clock.
    [[nodiscard]] double past_s() const { return -sites_.back().first_start_s; }

    // Returns the start of a site's volume, counted from 0.
    [[nodiscard]] UtcTime start_of(const NationalSite& site, int volume) const;
    // volumes() returns the volumes that begin before `until_s` on the feed's clock, in the order
    // of a replay. item_of() returns the item that replays a volume.
    [[nodiscard]] std::vector<NationalVolume> volumes(
        double until_s, level2::Moment moment = level2::Moment::ref) const;
    [[nodiscard]] synth::ReplayItem item_of(const NationalVolume& volume) const;

  private:
    std::vector<NationalSite> sites_;
    double period_s_ = 0;
    double expansion_ = 0;
};

[[nodiscard]] UtcTime national_start();  // UTC when the feed's clock is 0

}  // namespace stormcellar::bench

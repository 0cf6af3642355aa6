// bench/national_feed.h -- the heaviest national hour of Level II: 160 sites, 13.8 GB an hour in
// some 33 chunks a second.
//
// Sites     The first 160 WSR-88Ds by ICAO; if there are fewer, each sends as much.
// Volumes   Each site sends one of three real volumes again and again: six sites of eight a storm
//           with 94 chunks and 11.6 MB (KLOT, 2021, with MRLE), one KLBB 2016 (46 chunks, 4.0 MB),
//           one KLOT 2026 in clear air (55 chunks, 3.1 MB). All take `period`, from which the rate
//           follows, and the starts of the sites are spread evenly.
// On disk   A file for each site and hour: the records of the real volume with the site's name,
//           position and times, compressed again (bench/restamp.h). Within the hour,
//           volumes of a site differ only in the time in their headers: the times of the radials
//           are up to 40 minutes off, and gates are the same. This saves nothing in reading,
//           decompressing, decoding, gridding or storing them. A replay (synth/replay.h) plays
//           them.
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
#include "synth/replay.h"

namespace stormcellar::bench {

inline constexpr int national_sites = 160;
inline constexpr double heaviest_hour_bytes = 13.8e9;

struct NationalSite {
    Station station;
    int kind = 0;
    double first_start_s = 0;  // of its volume 0 on the feed's clock, not after 0
    std::uint64_t bytes = 0;   // of a volume
    std::size_t chunks = 0;
    std::vector<std::filesystem::path> hours;  // what it sends in each hour
};

// A volume that a site sends.
struct NationalVolume {
    std::size_t site = 0;
    int number = 0;  // of the site, from 0
    UtcTime start;
    std::string grid;  // the name of its grid's file
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

    // Bytes of the feed in a second of its clock.
    [[nodiscard]] double bytes_a_second() const;
    // The feed's clock is at 0 so long after the first site began.
    [[nodiscard]] double past_s() const { return -sites_.back().first_start_s; }

    // Returns the start of a site's volume, counted from 0.
    [[nodiscard]] UtcTime start_of(const NationalSite& site, int volume) const;
    // Returns what begins before `until_s` on the feed's clock, in the order of a replay, and what
    // to replay for it.
    [[nodiscard]] std::vector<NationalVolume> volumes(double until_s) const;
    [[nodiscard]] synth::ReplayItem item_of(const NationalVolume& volume) const;

  private:
    std::vector<NationalSite> sites_;
    double period_s_ = 0;
    double expansion_ = 0;
};

[[nodiscard]] UtcTime national_start();  // the time of the feed's clock at 0

}  // namespace stormcellar::bench

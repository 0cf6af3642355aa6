// batch/source.h -- the raw files of an archive: a directory, tars in it, or a public bucket.
//
// A volume is known by its file's name, which begins with a station and the time at which the
// volume begins (KTLX20130520_200356_V06.gz, 6500KTLX19910720_160529.Z). Nothing is decoded to make
// a plan.
//
// Units     Sizes are in bytes; days are of UTC.
// Threads   Pure functions, but for what they read.
// Errors    Those of reading directories and tars, and of fetch::fetch(). What is damaged is left
//           out; what cannot be read, which may pass, is an error.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/recipe.h"
#include "pipeline/care/archive_fill.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::batch {

struct NamedVolume {
    std::string station;
    UtcTime start;

    [[nodiscard]] std::chrono::sys_days day() const {
        return std::chrono::floor<std::chrono::days>(start);
    }
};
// Returns none for a name without a known station and a time, and for files of metadata (_MDM).
[[nodiscard]] std::optional<NamedVolume> volume_named(std::string_view file_name);

// The files that one station sent on one day. One task grids them.
struct StationDay {
    std::chrono::sys_days day;
    std::string station;
    // The directories and tars that hold its files, below the source, sorted. Empty: a bucket.
    std::vector<std::string> in;
    std::size_t files = 0;
    std::uint64_t bytes = 0;
};

// A station-day of a bucket is taken to have this size, because buckets are not listed for a plan.
inline constexpr std::uint64_t bytes_of_unlisted_day = 1'500'000'000;

struct SourceListing {
    std::vector<StationDay> days;  // by day, then station
    std::size_t nameless = 0;      // files whose names say no station and time
    std::string first_nameless;
    // Tars and members that may hold volumes and do not give them, with the reason.
    std::vector<std::string> cut;
    std::size_t links = 0;  // symbolic links, which are not followed
    std::filesystem::path first_link;
};
// Lists the volumes that begin in the range. Tars are read from end to end.
[[nodiscard]] Result<SourceListing> list_source(const std::string& source, UtcTime from,
                                                UtcTime to);
// A bucket is not listed for a plan: each station may have files on each day of the range.
[[nodiscard]] SourceListing every_day_of(const std::vector<std::string>& stations, UtcTime from,
                                         UtcTime to);

// The files of a station-day where they can be read, by start and name.
struct BroughtFiles {
    std::vector<std::filesystem::path> files;
    std::filesystem::path beneath;  // all are below this directory
    std::vector<pipeline::LeftOut> left_out;
};
// Members of tars and files of a bucket are brought to `scratch`, with the times that they have
// there. Files that the bucket lists and refuses to give are left out. Errors: also io if one could
// not be fetched for another reason, and busy after a stop.
[[nodiscard]] Result<BroughtFiles> bring(const Recipe& recipe, const StationDay& what,
                                         const std::filesystem::path& scratch,
                                         const std::atomic<bool>& stop);

}  // namespace stormcellar::batch

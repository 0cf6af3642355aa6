// batch/source.h -- finds the raw files of an archive in a directory, in its tars, or in a public
// bucket.
//
// The name of a file identifies its volume. It begins with a station and the start of the volume
// (KTLX20130520_200356_V06.gz, 6500KTLX19910720_160529.Z). So a plan can be made without decoding.
//
// Units     Sizes are in bytes; days are UTC.
// Threads   Functions without state.
// Errors    Those of reading directories and tars, and of fetch::fetch(). Damaged files are left
//           out. A file that cannot be read is an error, because another try may succeed.
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
// Returns none if the name has no known station or no time, or is of a file of metadata (_MDM).
[[nodiscard]] std::optional<NamedVolume> volume_named(std::string_view file_name);

// The files that one station sent on one day. One task grids them.
struct StationDay {
    std::chrono::sys_days day;
    std::string station;
    // The directories and tars that hold the files, relative to the source, sorted. Empty for a
    // bucket.
    std::vector<std::string> in;
    std::size_t files = 0;
    std::uint64_t bytes = 0;
};

// Size that a plan assumes for a station-day of a bucket, because a plan does not list buckets.
inline constexpr std::uint64_t bytes_of_unlisted_day = 1'500'000'000;

struct SourceListing {
    std::vector<StationDay> days;  // by day, then station
    std::size_t nameless = 0;      // files whose name has no station and time
    std::string first_nameless;
    // Tars and members that may hold volumes but cannot be read, with the reason.
    std::vector<std::string> cut;
    std::size_t links = 0;  // symbolic links, which are not followed
    std::filesystem::path first_link;
};
// Lists the volumes that begin in the range. Tars are read from end to end.
[[nodiscard]] Result<SourceListing> list_source(const std::string& source, UtcTime from,
                                                UtcTime to);
// Returns a listing of a bucket without asking the bucket. The listing assumes that each station
// has files on each day of the range.
[[nodiscard]] SourceListing every_day_of(const std::vector<std::string>& stations, UtcTime from,
                                         UtcTime to);

// The readable files of a station-day, sorted by start and name.
struct BroughtFiles {
    std::vector<std::filesystem::path> files;
    // the directory that holds all files; empty if some come from tars
    std::filesystem::path beneath;
    std::vector<pipeline::LeftOut> left_out;
};
// Makes the files of a station-day readable. Copies members of tars and files of a bucket to
// `scratch`, with their modification times. Leaves out files that the bucket lists but refuses.
// Errors: also io if a file could not be fetched for another reason, and busy after a stop.
[[nodiscard]] Result<BroughtFiles> bring(const Recipe& recipe, const StationDay& what,
                                         const std::filesystem::path& scratch,
                                         const std::atomic<bool>& stop);

}  // namespace stormcellar::batch

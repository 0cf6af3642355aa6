// export/climatology_netcdf.h -- writes statistics of many grids as CF netCDF.
//
// A group is an hour of the day, a month, or the whole time. For each group the file counts the
// frames, and for each column the frames in which it was seen and not seen. Over the frames in
// which a column was seen, the file gives how often its greatest value reached each threshold, the
// maximum, means and quantiles of that value, and how often the echo top (18.5 dBZ) was at or above
// each level. If cells were counted too, variables whose names begin with cell_ have the same
// statistics, except echo tops, for each cell. If a column or cell was never seen, or never had a
// value, its statistics have the fill value.
//
// Units     The attributes name them.
// Memory    The counts of all groups; the file in memory needs about as much again.
// Threads   Any thread; files are written one at a time.
// Errors    bad_argument for no group, or groups of different grids; internal if netCDF refuses;
//           those of the file system.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "grid/cells/grid_tally.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"

namespace stormcellar::netcdf {

struct TallyGroup {
    int number = 0;              // the hour, the month, or 0
    std::uint64_t instants = 0;  // number of times at which a frame was expected
    grid::GridTally tally;
};

// Name of the dimension of the groups, and global attributes of the file.
struct ClimatologyText {
    const char* group = "all";  // the name of the dimension: hour, month or all
    std::string time_coverage_start, time_coverage_end;
    std::string source;
};

[[nodiscard]] Status write_climatology(FileSystem& file_system, const std::filesystem::path& path,
                                       std::span<const TallyGroup> groups,
                                       const ClimatologyText& text);

}  // namespace stormcellar::netcdf

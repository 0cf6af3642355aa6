// export/climatology_netcdf.h -- writes statistics of many grids as CF netCDF.
//
// A group of grids is from one hour of the day, from one month, or from the whole time. For each
// group the file counts the frames, and for each column the frames in which the column was seen and
// not seen. From the frames in which a column was seen, the file gives how often the column's
// greatest value reached each threshold; the maximum, means and quantiles of that value; and how
// often the echo top (18.5 dBZ) was at or above each level. If cells were counted too, variables
// whose names begin with cell_ give the same statistics for each cell, except echo tops. The
// statistics of a column or cell that was never seen, or never had a value, are the fill value.
//
// Units     The attributes name them.
// Memory    The counts of all groups, and about as much again for the file in memory.
// Threads   Any thread may call it; files are written one at a time.
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

// The name of the dimension of groups, and the global attributes of the file.
struct ClimatologyText {
    const char* group = "all";  // name of the dimension: hour, month or all
    std::string time_coverage_start, time_coverage_end;
    std::string source;
};

[[nodiscard]] Status write_climatology(FileSystem& file_system, const std::filesystem::path& path,
                                       std::span<const TallyGroup> groups,
                                       const ClimatologyText& text);

}  // namespace stormcellar::netcdf

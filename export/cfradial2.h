// export/cfradial2.h -- writes a volume as CfRadial 2.1 (WMO FM 301-2022), netCDF-4 with a group
// for each sweep; internal to export.
//
// The root has the position and the names and angles of the sweeps. The groups sweep_0, sweep_1,
// ... are in the order of the file. A moment is a packed variable on (time, range) as in
// CfRadial 1.4 (stormcellar/export/cfradial.h): DBZH holds the codes as they came, and DBZH_status
// why a gate has no value. Each sweep has its own range, so RangeAxes matters only if the gates of
// one sweep differ. docs/export.md lists the variables.
//
// Units     CF units, named in the file.
// Threads   Any thread may call. Calls wait for each other, because the netCDF library is not
//           thread-safe.
// Errors    As write_volume() of stormcellar/export/cfradial.h.
// Accuracy  That of CfRadial 1.4.
// Source    CfRadial 2.1, NCAR/EOL, 2019; WMO Manual on Codes I.3, FM 301-2022.
#pragma once

#include <filesystem>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/export/cfradial.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

[[nodiscard]] Status write_cfradial2(FileSystem& file_system, const std::filesystem::path& path,
                                     const level2::Volume& volume,
                                     const VolumeWriteOptions& options);

}  // namespace stormcellar::netcdf

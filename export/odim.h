// export/odim.h -- writes a volume as ODIM_H5 2.4, a polar volume (PVOL) in HDF5; internal to
// export.
//
// Each sweep is a dataset; datasets are in the order of the file. A sweep whose moments differ in
// first gate or spacing has a dataset for each such geometry; how/scan_index, from 1, tells which
// sweep a dataset is of. Gates that differ in scale, offset or word size are in separate datasets,
// too, because a dataset has each quantity once.
//
// Rows are the radials by azimuth, as ODIM wants them; where/a1gate is the row of the radial that
// came first. how has the azimuths, elevations and times of the rows.
//
// Data are the codes as they came, in 8 or 16 bits with gain and offset. undetect is 0, below
// threshold. nodata is 1: range folded, ambiguous, a flag of the clutter filter, or no such gate,
// which ODIM cannot tell apart.
//
// Units     Degrees, meters, m/s, seconds since 1970.
// Threads   Any thread may call. Calls wait for each other, because the HDF5 library is not
//           thread-safe.
// Errors    As write_volume() of stormcellar/export/cfradial.h; unsupported for a sweep with more
//           radials than an attribute holds.
// Accuracy  The mean of startazA and stopazA is within 1e-12 degrees of the azimuth; startazT and
//           stopazT are both the time of the radial, to 1 us. A value is within 1e-12 (8-bit codes)
//           or 1e-11 (16-bit codes) of (code - offset) / scale.
// Source    EUMETNET OPERA weather radar information model for implementation with the HDF5 file
//           format, version 2.4, 2021.
#pragma once

#include <filesystem>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/export/cfradial.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

[[nodiscard]] Status write_odim(FileSystem& file_system, const std::filesystem::path& path,
                                const level2::Volume& volume, const VolumeWriteOptions& options);

}  // namespace stormcellar::netcdf

// stormcellar/export/cfradial.h -- a volume as CfRadial 1.4 netCDF-4, every gate where it was
// measured.
//
// Dimensions time (the radials of all sweeps, in file order), sweep, string_length, and range,
// range_2, ... for each pair of first gate and spacing that the volume holds. A moment is a packed
// integer variable named REF, VEL, SW, ZDR, PHI, RHO or CFP on (time, range): the codes as they
// came, with scale_factor and add_offset in double. Gates that differ from the most in range, scale
// or word size go to a second variable (REF_2 on range_2) instead of being resampled. Whatever is
// no value is _FillValue; REF_status keeps valid, below threshold, range folded and no data apart,
// and the flags of CFP. docs/export.md has every variable.
// Accuracy: unpacked in double, a value is within 1e-12 (codes of 8 bits) or 1e-11 (of 16 bits) of
// (code - offset) / scale.
// Without radials: a file whose time and sweep hold nothing. Without a position: latitude,
// longitude and altitude are _FillValue. Without a VCP: no scan_id, and fixed_angle is the median
// of the radials' elevations.
// The file is made in memory and appears whole or not at all (stormcellar/base/file_system.h); the
// same volume gives the same bytes, which name no time of writing. Source: CfRadial Data File
// Format, version 1.4, NCAR/EOL, 2016-08-01. Thread contract: any thread; calls wait for each
// other, because the netCDF library is not thread-safe.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

struct VolumeWriteOptions {
    std::string source_file;         // name of the raw file; empty: not said
    bool complete = true;            // the volume is whole
    std::vector<std::string> notes;  // what is to be known of the volume, e.g. its problems
    int deflate_level = 1;           // 0 to 9; 0: not compressed
};

// Errors: bad_argument for a deflate level out of range, a sweep without radials or arrays that do
// not fit each other; unsupported for more than 64 kinds of gates (a damaged file); io, no_space,
// permission, not_a_file and not_found from the file system; internal when netCDF refuses.
[[nodiscard]] Status write_volume(FileSystem& file_system, const std::filesystem::path& path,
                                  const level2::Volume& volume,
                                  const VolumeWriteOptions& options = {});

}  // namespace stormcellar::netcdf

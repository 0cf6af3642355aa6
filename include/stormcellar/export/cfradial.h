// stormcellar/export/cfradial.h -- writes a volume as CfRadial 1.4 netCDF-4, with the codes as the
// radar sent them.
//
// The dimensions are time (the radials of all sweeps, in file order), sweep, string_length and
// range. A moment is a packed integer variable named REF, VEL, SW, ZDR, PHI, RHO or CFP on (time,
// range). The variable holds the codes as they came, with scale_factor and add_offset in double. If
// the gates of a volume differ in length, RangeAxes chooses the axes: one axis, on which long gates
// are repeated, or one axis for each pair of first gate and spacing (REF_2 on range_2). Gates that
// differ in scale or word size are variables of their own (REF_2). No code is changed. A gate
// without a value is _FillValue; REF_status distinguishes valid, below threshold, range folded, no
// data and the flags of CFP. docs/export.md lists every variable.
//
// If the volume has no radials, time and sweep have no elements. If it has no position, latitude,
// longitude and altitude are _FillValue. If it has no VCP, there is no scan_id, and fixed_angle is
// the median of the radials' elevations.
//
// The file is made in memory and appears whole or not at all (stormcellar/base/file_system.h). The
// same volume gives the same bytes, because the file does not contain the time of writing.
//
// Units     CF units, named in the file.
// Threads   Any thread may call. Calls wait for each other, because the netCDF library is not
//           thread-safe.
// Errors    See write_volume().
// Accuracy  On one axis, the center of each element is inside the measured gate that the element
//           repeats, or on the far edge of that gate. Unpacked in double, a value is within 1e-12
//           (8-bit codes) or 1e-11 (16-bit codes) of (code - offset) / scale.
// Source    CfRadial Data File Format, version 1.4, NCAR/EOL, 2016-08-01.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

enum class RangeAxes : std::uint8_t {
    // One axis with the shortest spacing of the volume. A gate of N times that length is repeated N
    // times: at 250 m, a gate of 1 km is repeated four times. REF_gate_repeats (VEL_gate_repeats,
    // ...) gives N for each sweep. Programs that read only one axis (Py-ART, xradar) then find
    // every moment. If a spacing is not the shortest times a whole number from 1 to 8, if gates of
    // the shortest spacing are shifted by a part of a gate, or if the axis would have more than
    // 8192 elements, each geometry has its own axis.
    one_if_possible,
    of_each_geometry,  // Every gate appears once, where it was measured.
};

struct VolumeWriteOptions {
    std::string source_file;         // name of the raw file; empty: not written
    bool complete = true;            // the volume is whole
    std::vector<std::string> notes;  // notes for readers of the volume, e.g. its problems
    int deflate_level = 1;           // 0 to 9; 0: not compressed
    RangeAxes ranges = RangeAxes::one_if_possible;
};

// Writes the file. Errors: bad_argument for a deflate level out of range, a sweep without radials,
// or arrays that do not fit each other; unsupported for more than 64 kinds of gates (a damaged
// file); io, no_space, permission, not_a_file and not_found from the file system; internal if
// netCDF refuses.
[[nodiscard]] Status write_volume(FileSystem& file_system, const std::filesystem::path& path,
                                  const level2::Volume& volume,
                                  const VolumeWriteOptions& options = {});

}  // namespace stormcellar::netcdf

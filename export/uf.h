// export/uf.h -- writes a volume as Universal Format (UF); internal to export.
//
// A file is a list of radials in the order of the volume, each a Fortran record of big-endian words
// of 16 bits: 4 bytes with its length, the words, the length again.
//
//   word    mandatory header (45 words)                 word    data header
//   1       "UF"                                        1       fields of this radial
//   2       words of the record                         2       records of this radial: 1
//   3 4 5   first word of the optional, local and       3       fields of this record
//           data header: all 46                         4 ...   name and first word of each field
//   6       record, from 1
//   7       volume                                      word    field header (21 or 25 words)
//   8 9     radial, from 1; its record: 1               1       first word of data
//   10      sweep, from 1                               2 16    factor: value = word / factor
//   11-18   radar, site                                 3 4     kilometers and meters to the center
//   19-24   latitude, longitude: degrees, minutes,              of the first gate
//           seconds * 64                                5 6     meters between gates, gates
//   25      altitude of the antenna, m                  7-10    pulse, beam widths, bandwidth
//   26-32   year to second, "UT"                        11      polarization: 0, horizontal
//   33 34   azimuth, elevation * 64                     12-18   wavelength, samples, thresholds,
//   PRT 35 36   mode: 1, PPI; fixed angle * 64              19      bits of a word: 16 37 degrees
//   of azimuth in a second * 64         20      VR, VE: Nyquist velocity * factor 38-44   day of
//   the volume, "stormcel"               20-25   others: unknown 45      the word of what is
//   missing: -32768
//
// All fields of the volume are in each radial, with one factor, on the range axis of CfRadial 1.4
// (RangeAxes::one_if_possible): readers such as Py-ART take fields, factors, gates and range of all
// radials from the first. So the first radial of a sweep has as many gates as the longest radial of
// the sweep, and the first radial of the volume has as many gates as the axis. If there is no such
// axis, or with RangeAxes::of_each_geometry, a radial has only its own fields, each with its own
// gates.
//
// UF has one word for all gates without a value. It has whole seconds, and 1/64 degree.
//
// Units     As in the table.
// Threads   Any thread.
// Errors    As write_volume() of stormcellar/export/cfradial.h; unsupported for a volume without
//           radials, for more than 32,767 radials or words of a radial, and for values that 16 bits
//           cannot hold.
// Accuracy  export/uf_scale.h has that of the values. Azimuth and elevation to 1/128 degree.
// Source    S. L. Barnes, "Report on a meeting to establish a common Doppler radar data exchange
//           format", BAMS 61 (1980), 1401-1404.
#pragma once

#include <filesystem>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/export/cfradial.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

[[nodiscard]] Status write_uf(FileSystem& file_system, const std::filesystem::path& path,
                              const level2::Volume& volume, const VolumeWriteOptions& options);

}  // namespace stormcellar::netcdf

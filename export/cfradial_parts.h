// export/cfradial_parts.h -- code that the writers of CfRadial 1.4 and CfRadial 2 share; internal
// to export.
//
// CfRadial 1.4 has all sweeps in one group, one after the other. CfRadial 2 has a group for each
// sweep, which these functions write like a file of a single sweep.
//
// Threads   Hold library_mutex() (export/netcdf_builder.h) during all calls.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "export/cfradial_layout.h"
#include "export/netcdf_builder.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/export/cfradial.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

inline constexpr std::size_t string_length = 32;

// The sweeps that are written into the file or its current group.
struct CfradialParts {
    NetcdfBuilder& file;
    std::span<const level2::Sweep> sweeps;  // those of the layout
    const CfradialLayout& layout;
    UtcTime reference;  // the whole second from which `time` counts
    int deflate_level;
    int time;                 // dimension
    std::vector<int> sweep;   // the dimension of the sweeps; empty in the group of a single sweep
    std::vector<int> ranges;  // the dimension of each axis of the layout

    // Makes a variable with the attributes that every variable has.
    int variable(const char* name, int type, const std::vector<int>& dimensions,
                 const char* long_name, const char* units) const;
};

using Known = std::optional<float>;  // none: Level II does not tell it
// Returns the value, or none for 0, which Level II writes for an unknown number.
[[nodiscard]] Known unless_zero(float value);
// Writes a variable of floats, with _FillValue for each unknown value. Makes no variable if all
// values are unknown, and then returns NetcdfBuilder::file.
int write_known(const CfradialParts& parts, const char* name, const std::vector<int>& dimensions,
                const char* long_name, const char* units, const std::vector<Known>& values);
void write_ints(const CfradialParts& parts, const char* name, const std::vector<int>& dimensions,
                const char* long_name, const std::vector<int>& values);

// Write the variables on `time` and on the ranges.
void write_radial_variables(const CfradialParts& parts);
void write_axes(const CfradialParts& parts);
void write_fields(const CfradialParts& parts);

// Fails with bad_argument if the level is not 0 to 9.
[[nodiscard]] Status check_deflate_level(const VolumeWriteOptions& options);

// The facts that differ between the two versions.
struct CfradialVersion {
    const char* conventions;
    const char* version;
    const char* standard;  // as `references` names it
    const char* comment;
};
// Write attributes and variables of the volume.
void write_titles(NetcdfBuilder& file, const level2::Volume& volume,
                  const VolumeWriteOptions& options, UtcTime reference,
                  const CfradialVersion& version);
void write_power_attributes(NetcdfBuilder& file, const level2::Volume& volume);
void write_volume_number(NetcdfBuilder& file, const level2::Volume& volume);
void write_position(NetcdfBuilder& file, const level2::Volume& volume);

// Makes a variable with a long name, and with units unless they are null.
int described_variable(NetcdfBuilder& file, const char* name, int type,
                       const std::vector<int>& dimensions, const char* long_name,
                       const char* units);

}  // namespace stormcellar::netcdf

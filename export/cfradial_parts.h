// export/cfradial_parts.h -- the parts of a CfRadial file; internal to export/cfradial.
//
// Threads   Hold library_mutex() (export/netcdf_builder.h).
#pragma once

#include <string>
#include <vector>

#include "export/cfradial_layout.h"
#include "export/netcdf_builder.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

inline constexpr std::size_t string_length = 32;

// The volume that all parts write, and the file into which they write it.
struct CfradialParts {
    NetcdfBuilder& file;
    const level2::Volume& volume;
    const CfradialLayout& layout;
    UtcTime reference;  // `time` counts from this whole second
    int deflate_level;
    int time, sweep, letter;  // dimensions
    std::vector<int> ranges;  // the dimension of each axis of the layout

    // Makes a variable with the attributes that every variable has.
    int variable(const char* name, int type, const std::vector<int>& dimensions,
                 const char* long_name, const char* units) const;
    // Writes one word for each element of the dimension, or one word without a dimension.
    int words(const char* name, const std::vector<int>& dimensions, const char* long_name,
              const std::vector<std::string>& values) const;
};

void write_sweep_variables(const CfradialParts& parts);
void write_radial_variables(const CfradialParts& parts);
void write_fields(const CfradialParts& parts);

}  // namespace stormcellar::netcdf

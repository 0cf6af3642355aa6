// export/cfradial_parts.h -- code that the writers of a CfRadial file share; internal to export.
//
// Threads   Hold library_mutex() (export/netcdf_builder.h) during all calls.
#pragma once

#include <string>
#include <vector>

#include "export/cfradial_layout.h"
#include "export/netcdf_builder.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

inline constexpr std::size_t string_length = 32;

// The volume that is written, and the file into which all writers of its variables write.
struct CfradialParts {
    NetcdfBuilder& file;
    const level2::Volume& volume;
    const CfradialLayout& layout;
    UtcTime reference;  // the whole second from which `time` counts
    int deflate_level;
    int time, sweep, letter;  // dimensions
    std::vector<int> ranges;  // the dimension of each axis of the layout

    // Makes a variable with the attributes that every variable has.
    int variable(const char* name, int type, const std::vector<int>& dimensions,
                 const char* long_name, const char* units) const;
    // Writes one word for each element of the dimension, or a single word if there is no dimension.
    int words(const char* name, const std::vector<int>& dimensions, const char* long_name,
              const std::vector<std::string>& values) const;
};

void write_sweep_variables(const CfradialParts& parts);
void write_radial_variables(const CfradialParts& parts);
void write_fields(const CfradialParts& parts);

}  // namespace stormcellar::netcdf

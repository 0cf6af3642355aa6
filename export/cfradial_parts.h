// export/cfradial_parts.h -- the parts of a CfRadial file; internal to export/cfradial.
#pragma once

#include <string>
#include <vector>

#include "export/cfradial_layout.h"
#include "export/netcdf_builder.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

inline constexpr std::size_t string_length = 32;

// Where the parts write to, and what.
struct CfradialParts {
    NetcdfBuilder& file;
    const level2::Volume& volume;
    const CfradialLayout& layout;
    UtcTime reference;  // what `time` counts from, a whole second
    int deflate_level;
    int time, sweep, letter;  // dimensions
    std::vector<int> ranges;  // the dimension of each of the layout's axes

    // A variable with the attributes that every one has.
    int variable(const char* name, int type, const std::vector<int>& dimensions,
                 const char* long_name, const char* units) const;
    // One word for each of the dimension's elements; no dimension: one word.
    int words(const char* name, const std::vector<int>& dimensions, const char* long_name,
              const std::vector<std::string>& values) const;
};

void write_sweep_variables(const CfradialParts& parts);
void write_radial_variables(const CfradialParts& parts);
void write_fields(const CfradialParts& parts);

}  // namespace stormcellar::netcdf

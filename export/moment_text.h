// export/moment_text.h -- the names of a moment in netCDF files; internal to export.
#pragma once

#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

struct MomentText {
    const char* long_name;
    const char* cf_name;        // standard name in CF's own table; null if it has none
    const char* cfradial_name;  // proposed by CfRadial 1.4, section 6.1; null if it has none
};

[[nodiscard]] MomentText text_of(level2::Moment moment);

}  // namespace stormcellar::netcdf

// export/moment_text.h -- what a moment is called in netCDF files: export's layer over
// stormcellar/level2/moment.h.
#pragma once

#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

struct MomentText {
    const char* long_name;
    const char* cf_name;        // standard name of CF's own table; null where it has none
    const char* cfradial_name;  // proposed by CfRadial 1.4, section 6.1; null where it has none
};

[[nodiscard]] MomentText text_of(level2::Moment moment);

}  // namespace stormcellar::netcdf

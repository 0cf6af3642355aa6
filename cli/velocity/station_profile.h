// cli/velocity/station_profile.h -- the wind profiles of the volumes that a command line names.
//
// Threads   One thread at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/shared/input_files.h"
#include "cli/shared/site_options.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/retrieve/storm_motion.h"
#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::cli {

struct StationProfile {
    std::string file;
    std::string station;          // empty: unknown
    std::optional<UtcTime> time;  // start of the volume
    double antenna_altitude_m = 0;
    std::vector<retrieve::WindLayer> layers;  // heights above the antenna
    Result<retrieve::StormMotions> motions = retrieve::StormMotions{};

    [[nodiscard]] bool has_wind() const;
};

struct ProfileRequest {
    retrieve::WindProfileOptions wind;
    SiteRequest site;
    int threads = 1;
};

// Decodes a file, unfolds its velocities and returns the profile of each of its volumes. Errors
// name the file: those of InputFiles::decode(), apply_site() and wind_profile(); not_found if the
// position of the radar is unknown.
[[nodiscard]] Result<std::vector<StationProfile>> profiles_of(InputFiles& inputs,
                                                              const InputFile& file,
                                                              const ProfileRequest& request);

}  // namespace stormcellar::cli

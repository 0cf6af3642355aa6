// cli/shared/site_options.h -- the options that name a file's radar and its position.
//
// The options are for radars whose position is neither in the file nor in the station table: radars
// in files of the nineties, test beds, mobile and foreign radars. The configuration of a daemon has
// [[station]] tables for the same purpose.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cli/shared/commands.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::cli {

// The options as they were typed.
struct SiteOptions {
    std::string station;
    std::string position;
};
void add_site_options(CLI::App& app, SiteOptions& options);
// The end of a message about a radar whose position is unknown. It says how to give the position.
inline constexpr std::string_view how_to_place =
    "; name the radar with --station ICAO, or give its position with --position LAT,LON,HEIGHT";

struct SiteRequest {
    std::string station;  // empty: as in the file
    struct Position {
        double latitude_deg = 0;
        double longitude_deg = 0;
        double antenna_altitude_m = 0;  // above mean sea level
    };
    std::optional<Position> position;  // none: from the file or the table
};
// Parses the options. Errors: bad_argument, naming the option.
[[nodiscard]] Result<SiteRequest> parse_site(const SiteOptions& options);

// Gives the volume the requested name and position. Also adds them to the process's station table,
// so call it while no other thread uses that table. Errors: bad_argument for a position without a
// name.
[[nodiscard]] Status apply_site(const SiteRequest& request, level2::Volume& volume);

}  // namespace stormcellar::cli

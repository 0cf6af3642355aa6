// cli/shared/site_options.h -- which radar a file is of, and where it stands, said on the command
// line.
//
// For radars that neither the file nor the station table places: files of the nineties, test beds,
// mobile and foreign radars. A daemon has [[station]] tables for the same.
#pragma once

#include <optional>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/volume.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

// As they were typed.
struct SiteOptions {
    std::string station;
    std::string position;
};
void add_site_options(CLI::App& app, SiteOptions& options);

struct SiteRequest {
    std::string station;  // empty: what the file says
    struct Position {
        double latitude_deg = 0;
        double longitude_deg = 0;
        double antenna_altitude_m = 0;  // above mean sea level
    };
    std::optional<Position> position;  // none: that of the file or the table
};
// Errors: bad_argument, naming the option.
[[nodiscard]] Result<SiteRequest> parse_site(const SiteOptions& options);

// Gives the volume the name and the position that were asked for; the station table of this process
// has them from then on. To be called while no other thread asks for stations.
// Errors: bad_argument for a position without a name.
[[nodiscard]] Status apply_site(const SiteRequest& request, level2::Volume& volume);

}  // namespace stormcellar::cli

// level2/foreign/quantity_names.h -- names of moments and of radars in files of other formats.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/level2/moment.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct Quantity {
    Moment moment = Moment::ref;
    int rank = 0;  // of several quantities for one moment, the lowest rank is used
};

// Finds the moment of a quantity by its name in ODIM_H5, CfRadial or common use ("DBZH", "VRADH",
// "reflectivity"), or none. Ignores case.
[[nodiscard]] std::optional<Quantity> quantity_named(std::string_view name);
// Finds the moment of a standard name of CfRadial.
[[nodiscard]] std::optional<Quantity> quantity_of_standard_name(std::string_view name);

// Returns a station of four letters for a radar of another network, whose name may be longer:
// - The node of ODIM_H5, as in "NOD:sekir,WMO:02606", without its second letter: SKIR.
// - Else the first four letters and digits of the name, filled up with X.
// If the station table has a radar of this name more than a degree away, the last letters become a
// checksum of the name. Returns an empty text for an empty name.
[[nodiscard]] std::string station_of(std::string_view name, const VolumeBlock& position);

}  // namespace stormcellar::level2

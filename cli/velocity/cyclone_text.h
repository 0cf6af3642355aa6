// cli/velocity/cyclone_text.h -- a hurricane as a table for people and as JSON for programs.
//
// Units     The table has km and m/s, JSON meters and m/s. Heights are above mean sea level.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/retrieve/cyclone.h"

namespace stormcellar::cli {

struct StationCyclone {
    std::string station;
    std::optional<UtcTime> time;
    double antenna_altitude_m = 0;
    retrieve::Cyclone cyclone;
};

// Returns lines on the center, the maximum, the mean wind and the pressure, and a row for the
// maximum and every fifth kilometer. Each value has its standard error.
[[nodiscard]] std::string cyclone_table(const StationCyclone& found);
// Returns all rings.
[[nodiscard]] nlohmann::ordered_json cyclone_json(const StationCyclone& found);
[[nodiscard]] nlohmann::ordered_json no_cyclone_json(const retrieve::NoCyclone& none);

}  // namespace stormcellar::cli

// cli/picture/nowcast_text.h -- the report of `nowcast`, as a table and as JSON.
//
// Threads   Pure functions.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "retrieve/nowcast/hindcast.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

struct NowcastReport {
    std::string domain;
    UtcTime latest;   // time of the latest grid
    int volumes = 0;  // number of grids
    // The motion of all echo together.
    double speed_mps = 0, toward_deg = 0;
    std::vector<retrieve::LeadScore> scores;
    std::vector<std::string> written;  // files by lead; empty: none were requested
};

[[nodiscard]] std::string nowcast_table(const NowcastReport& report);
[[nodiscard]] nlohmann::ordered_json nowcast_json(const NowcastReport& report);

}  // namespace stormcellar::cli

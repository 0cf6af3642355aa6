// notify/notice.h -- decides which cells a rule reports, and writes the messages.
//
// A cell is at the place if its center of mass is within the radius. It passes if it reaches all
// thresholds of the rule; an unknown value, such as MESH without echo above the freezing level,
// reaches no threshold. A rule reports a cell again only after `every`, by the times of the grids.
//
// Units     Meters in C++. The names in the message end with their units.
// Threads   Pure functions.
// Errors    None.
// Accuracy  Distances are geodesics of WGS84 (15 nanometers). The closest approach is that of
//           straight lines between the forecasts in the azimuthal equidistant plane about the
//           place. tests/notify/notice_test.cpp compares it with a straight motion: 1 m within 100
//           km.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "notify/notify_config.h"
#include "notify/outbox.h"
#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::notify {

// The point closest to a place on the path that a cell takes in the next hour if it keeps its
// motion.
struct ClosestApproach {
    double distance_m = 0;
    UtcTime time;
    // The standard deviation of the position along each axis, interpolated between the forecasts
    // before and after. Until the first forecast, it is the error of the first forecast, an upper
    // bound.
    double error_m = 0;
};
// Returns none for a cell without forecasts.
[[nodiscard]] std::optional<ClosestApproach> closest_approach(const NotifyRule& rule,
                                                              const retrieve::TrackedCell& cell);

[[nodiscard]] bool passes(const Thresholds& thresholds, const retrieve::StormCell& cell);

// Returns the time of the grid of the last message about a cell; none if there was no message.
using LastMessage = std::function<std::optional<UtcTime>(const std::string& cell)>;

struct Notice {
    MessageName name;
    std::string text;  // one JSON object
};
// Returns the messages of a rule about the cells of a scan, the strongest cell first. `freezing`
// are the levels with which the cells were found.
[[nodiscard]] std::vector<Notice> notices_of(const NotifyRule& rule,
                                             const retrieve::TrackedScan& scan,
                                             const retrieve::FreezingLevels& freezing,
                                             const LastMessage& last_of);

}  // namespace stormcellar::notify

// stormcellar/render/frame_facts.h -- the facts that the labels of a picture give about its grid.
//
// Threads   Plain data.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/storm_motion.h"

namespace stormcellar::render {

struct FrameFacts {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
    std::vector<grid::SitePosition> sites;
    bool partial = false;
    // The local time of the grid, "1999-05-03 18:56:21 CDT", or empty.
    std::string local_time = {};
    // The time from the newest radial to now, for a picture that is made while its data are new.
    std::optional<std::chrono::seconds> antenna_to_picture = {};
    // The faults that radars report about themselves: "KTLX: standby, maintenance required".
    std::vector<std::string> radar_troubles = {};
    std::vector<std::string> left_out = {};  // machines whose data are missing (grid::Provenance)
    // The motion to which the storm-relative velocity SRV refers, if all sites have the same
    // motion.
    std::optional<retrieve::Motion> storm_motion = {};
    // Remark on the echo that was left out as probably no weather (quality_in_notes()), or empty.
    std::string quality = {};
    // The rung that dealiased the velocities of a grid of shear; empty for other grids.
    std::string dealiasing = {};
    std::optional<UtcTime> since = {};  // the first volume of a product over time
    std::string rain = {};  // of a rain total: "180 minutes, 12 of them without volumes"; or empty
    bool interpolated = false;  // the grid was interpolated between volumes, as requested
    // For a nowcast, what it is and its measured error (retrieve/nowcast/nowcast_note.h); else
    // empty.
    std::string nowcast = {};
    std::string nowcast_score = {};
};

}  // namespace stormcellar::render

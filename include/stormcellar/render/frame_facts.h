// stormcellar/render/frame_facts.h -- what a picture's labels say about its grid.
//
// Thread contract: plain data.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::render {

struct FrameFacts {
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;
    std::vector<grid::SitePosition> sites;
    bool partial = false;
    // The rest may be left empty. The time where somebody is, "1999-05-03 18:56:21 CDT".
    std::string local_time = {};
    // From the newest radial to now, of a picture made while it is news.
    std::optional<std::chrono::seconds> antenna_to_picture = {};
    // What radars say is wrong with them, "KTLX: standby, maintenance required".
    std::vector<std::string> radar_troubles = {};
    bool interpolated = false;  // between volumes, as it was called for
};

}  // namespace stormcellar::render

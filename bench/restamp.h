// bench/restamp.h -- a volume as if another radar had sent it at another time.
//
// Gates, angles, the pattern and all that is measured stay as they are. Threads: pure functions.
#pragma once

#include <chrono>

#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

// The header's time and that of every radial that says one that a radar can have meant.
void move_times(level2::Volume& volume, std::chrono::milliseconds by);

// The volume starts at `start` (whole milliseconds) and is that station's: the ICAO of the header
// (one is made where there is none), of the radials, and the position in message 31's volume block.
// Message 1 holds no position: its reader takes that of the station table.
void restamp(level2::Volume& volume, const Station& station, UtcTime start);

// The position in a volume block that has that station's antenna.
void move_to(const Station& station, level2::VolumeBlock& block);

}  // namespace stormcellar::bench

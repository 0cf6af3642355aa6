// bench/restamp.h -- changes a volume as if another radar had sent it at another time.
//
// Gates, angles, the pattern and everything measured are unchanged.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <chrono>

#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

// Moves the time of the header and of every radial whose time is plausible.
void move_times(level2::Volume& volume, std::chrono::milliseconds by);

// The volume then starts at `start` (whole milliseconds) and belongs to the station: the ICAO of
// the header (one is made if there is none) and of the radials, and the position in the volume
// block of message 31, are those of the station. Message 1 has no position; its reader takes that
// of the station table.
void restamp(level2::Volume& volume, const Station& station, UtcTime start);

// Gives the volume block the position of the station's antenna.
void move_to(const Station& station, level2::VolumeBlock& block);

}  // namespace stormcellar::bench

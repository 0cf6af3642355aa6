// bench/restamp.h -- makes of a volume, or of a file of LDM records, what another radar would have
// sent at another time. Gates, angles, the pattern and everything measured are unchanged.
//
// Threads   Pure, and const functions, which may be called from any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/measure.h"
#include "stormcellar/base/result.h"
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

// A file of LDM records, re-stamped as restamp() does, but in the messages themselves: the records
// remain as the RDA cut them, with everything that a Volume does not hold, and are compressed
// again. In messages 31 the station, both times and the position are changed; all other messages
// are unchanged.
class StampedRecords {
  public:
    // Errors: not_level2 for anything but a header and whole LDM records after it; corrupt for a
    // record that is no bzip2 stream.
    [[nodiscard]] static Result<StampedRecords> read(std::span<const std::byte> file);

    // Returns the file with the start at `start` (whole milliseconds).
    [[nodiscard]] Bytes stamped(const Station& station, UtcTime start) const;
    [[nodiscard]] std::uint64_t message_bytes() const;

  private:
    struct Record {
        Bytes messages;
        bool negative = false;  // control word
    };
    Bytes header_;
    UtcTime start_;
    std::vector<Record> records_;
};

// Writes another time into the header's 24 bytes.
void stamp_header_time(std::span<std::byte> header, UtcTime start);

}  // namespace stormcellar::bench

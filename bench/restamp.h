// bench/restamp.h -- changes a volume, or a file of LDM records, as if another radar had sent it at
// another time. Gates, angles, the pattern and all measurements stay the same.
//
// Threads   Functions without state; const functions may be called from any thread.
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

// Makes the volume start at `start` (whole milliseconds) and belong to the station. Sets the ICAO
// in the header (which is made if there is none) and in the radials, and the position in the volume
// block of message 31. Message 1 has no position; its reader uses the station table.
void restamp(level2::Volume& volume, const Station& station, UtcTime start);

// A file of LDM records that is re-stamped like a volume in restamp(), but byte by byte. So the
// messages keep the order and the contents that the RDA gave them, including contents that a Volume
// cannot hold. Only station, times and position in messages 31 change; then the records are
// compressed again.
class StampedRecords {
  public:
    // Errors: not_level2 for anything but a header and whole LDM records after it; corrupt for a
    // record that is not a bzip2 stream.
    [[nodiscard]] static Result<StampedRecords> read(std::span<const std::byte> file);

    // Returns the file of a volume that starts at `start` (whole milliseconds).
    [[nodiscard]] Bytes stamped(const Station& station, UtcTime start) const;
    [[nodiscard]] std::uint64_t message_bytes() const;

  private:
    struct Record {
        Bytes messages;
        bool negative = false;  // sign of the record's control word
    };
    Bytes header_;
    UtcTime start_;
    std::vector<Record> records_;
};

// Writes another time into the header's 24 bytes.
void stamp_header_time(std::span<std::byte> header, UtcTime start);

}  // namespace stormcellar::bench

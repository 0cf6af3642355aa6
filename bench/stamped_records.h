// bench/stamped_records.h -- a file of LDM records as another radar would have sent it, record by
// record.
//
// It does to the messages themselves what restamp.h does to a decoded volume. The records remain as
// the RDA cut them, with everything that a Volume does not hold, and are compressed again. In
// messages 31 the station, both times and the position are changed; all other messages are
// unchanged.
//
// Threads   Const functions may be called from any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/measure.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

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

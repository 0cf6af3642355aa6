// tests/fault/hostile_files.h -- makes Level II bytes that claim whatever a test wants.
//
// The files are small, of message 31, with one moment. They may claim any station, position, time,
// scale and offset, and may lack an end. This code does not use stormcellar/level2/encode.h, which
// refuses to write most of these files.
//
// Threads   Functions without state; call them from any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "stormcellar/base/utc_time.h"
#include "tests/level2/wire.h"

namespace stormcellar::fault {

using level2::wire::Bytes;

struct Claims {
    std::string station = "KTLX";
    NexradTime time;  // of the header and of every radial
    float latitude_deg = 0, longitude_deg = 0;
    unsigned sweeps = 1, radials = 360, gates = 100;
    unsigned word_bits = 8;
    unsigned code = 100;     // of the gates
    bool is_varied = false;  // true: each radial has its own code, and `code` is not used
    float scale = 2, offset = 66;
};

// Returns claims with the name and position of a station of the table. Throws for any other
// station.
[[nodiscard]] Claims claims_of(std::string_view known_station, UtcTime start);

// Returns one of 17,576 names that are not in the table: "XAAA", "XAAB" and so on.
[[nodiscard]] std::string invented_station(std::size_t number);
[[nodiscard]] Claims invented_claims(std::size_t number, UtcTime start);

// Returns the 24 bytes before the first record.
[[nodiscard]] Bytes file_header(const Claims& claims, int number = 1);
// Returns the radials of sweep number `sweep`; the first is 0.
[[nodiscard]] Bytes sweep_messages(const Claims& claims, unsigned sweep);
// Returns a whole volume: the header and one record.
[[nodiscard]] Bytes volume_bytes(const Claims& claims);
// Returns the volume of volume_bytes() without compression, which is faster to make.
[[nodiscard]] Bytes plain_volume_bytes(const Claims& claims);
// Returns the header and records of one sweep that does not end: `radials` radials (a multiple of
// 125) of `gates` gates of 16 bits. With the defaults, the file has some 23 kB and unpacks to 50
// MB.
[[nodiscard]] Bytes endless_bytes(Claims claims, unsigned radials = 1250, unsigned gates = 20'000);
// Returns the control word of a record of `bytes` bytes, and the start of its stream.
[[nodiscard]] Bytes begun_record(std::uint32_t bytes);
// Returns a volume that can be read in full but whose values in a grid are not finite.
[[nodiscard]] Bytes overflowing_bytes(Claims claims);

}  // namespace stormcellar::fault

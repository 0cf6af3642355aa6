// tests/fault/hostile_files.h -- Level II bytes that claim whatever a test wants them to claim.
//
// Small files of message 31 with one moment: of any station, position, time, scale and offset, that
// end or never end. Independent of stormcellar/level2/encode.h, which refuses to write most of
// these. Thread contract: pure functions.
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
    unsigned code = 100;     // of every gate,
    bool is_varied = false;  // or of each radial another one
    float scale = 2, offset = 66;
};

// The claims of a station of the table, with its position; throws for any other.
[[nodiscard]] Claims claims_of(std::string_view known_station, UtcTime start);

// "XAAA", "XAAB" and so on, none of the table: 17,576 names.
[[nodiscard]] std::string invented_station(std::size_t number);
[[nodiscard]] Claims invented_claims(std::size_t number, UtcTime start);

// The 24 bytes before the first record.
[[nodiscard]] Bytes file_header(const Claims& claims, int number = 1);
// The radials of one sweep, counted from 0.
[[nodiscard]] Bytes sweep_messages(const Claims& claims, unsigned sweep);
// A whole volume: the header and one record.
[[nodiscard]] Bytes volume_bytes(const Claims& claims);
// The same without compression, which is quicker to make.
[[nodiscard]] Bytes plain_volume_bytes(const Claims& claims);
// The header and records of one sweep that does not end: `radials` radials (a multiple of 125) of
// `gates` gates of 16 bits. Of 1,250 and 20,000 it unpacks to 50 MB, and has some 23 kB.
[[nodiscard]] Bytes endless_bytes(Claims claims, unsigned radials = 1250, unsigned gates = 20'000);
// The control word of a record of so many bytes, and the start of its stream.
[[nodiscard]] Bytes begun_record(std::uint32_t bytes);
// A volume that is read in full and whose cells are no finite numbers.
[[nodiscard]] Bytes overflowing_bytes(Claims claims);

}  // namespace stormcellar::fault

// stormcellar/level2/encode.h -- encodes a Volume as the bytes of a Level II file.
//
// encode() writes an Archive II file as the RDA would send it. A 24-byte header is followed by a
// metadata record of 134 frames with messages 5 and 2 at their places. The frames of clutter maps
// and adaptation data stay empty, as in files of TDWRs: a Volume does not hold these data, and they
// are not made up. Then come LDM bzip2 records of up to 120 radials (message 1: 100), none of which
// spans two sweeps; the last control word is negative. Sweeps of message 31 are written as message
// 31, those of message 1 as message 1.
//
// decode(encode(v)) gives v to the bit. The decoder reads each record that encode() makes, and
// encode() refuses a volume of which anything would be lost, rounded, joined or split. The bytes do
// not hold two facts. One is that a volume had no header: it gets one, AR2V0006.001 or
// AR2V0001.001, with the time of the first radial. The other is the station, if there are neither
// radials of message 31 nor an ICAO in the header. The decoder then needs the station as its
// fallback.
//
// Units     Those of stormcellar/level2/volume.h.
// Memory    A second copy of the volume.
// Threads   Pure functions.
// Errors    bad_argument for a volume that would not come back; the message names the part, with
//           indices from 0. Such volumes include numbers between the steps of a field (Nyquist
//           velocity 0.01 m/s, unambiguous range 100 m, thresholds 0.1 and 0.125 dB, elevation of a
//           cut 180/32768 degrees), several patterns, codes beyond the gates of a row, and volumes
//           beyond the limits of decode().
// Source    ICD 2620002W tables II, III, IV, XI, XVII; ICD 2620010 section 7.
#pragma once

#include <cstddef>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/chunk_name.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// One LDM record: its control word and its bzip2 stream.
struct EncodedRecord {
    std::vector<std::byte> bytes;
};

struct EncodedChunk {
    ChunkName name;
    std::vector<std::byte> bytes;
};

struct EncodedVolume {
    UtcTime start;
    std::vector<std::byte> header;  // the 24 bytes
    std::vector<EncodedRecord> records;

    [[nodiscard]] std::vector<std::byte> joined() const;  // header and records: a whole file
    // Returns the same as chunks, which are named by the start of the volume. One chunk (S) has the
    // header and the metadata. Then there is one chunk for each record (I, the last E). There must
    // be no more than 999.
    [[nodiscard]] std::vector<EncodedChunk> chunks() const;
};

struct EncodeOptions {
    int compression_level = 9;  // bzip2 block size, 100 kB units
    int radials_per_record = 120;
};

[[nodiscard]] Result<EncodedVolume> encode(const Volume& volume, const EncodeOptions& options = {});

}  // namespace stormcellar::level2

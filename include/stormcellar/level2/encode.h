// stormcellar/level2/encode.h -- encodes a Volume as the bytes of a Level II file.
//
// encode() writes an Archive II file as the RDA would send it. A 24-byte header is followed by a
// metadata record of 134 frames with messages 5 and 2 at their usual places. The frames of clutter
// maps and adaptation data stay empty, as in files of TDWRs, because a Volume does not hold these
// data. LDM bzip2 records of up to 120 radials (message 1: 100) follow. No record spans two sweeps,
// and the last control word is negative. Each sweep keeps its message type, 31 or 1.
//
// decode(encode(v)) gives v to the bit. encode() decodes each record that it makes, and refuses a
// volume in which anything would be lost, rounded, joined or split. There are two exceptions. A
// volume without a header gets the header AR2V0006.001 or AR2V0001.001 with the time of the first
// radial. A volume without radials of message 31 and without an ICAO in the header loses its
// station; give the decoder the station as DecodeOptions::fallback_station.
//
// Units     Those of stormcellar/level2/volume.h.
// Memory    A second copy of the volume, made to check the result.
// Threads   Pure functions.
// Errors    bad_argument for a volume that decode() would not return unchanged; the message names
//           the part, with indices from 0. Such volumes have numbers between the steps of a field
//           (Nyquist velocity 0.01 m/s, unambiguous range 100 m, thresholds 0.1 and 0.125 dB,
//           elevation of a cut 180/32768 degrees), several patterns, codes beyond the gates of a
//           row, or more data than decode() allows. bad_argument also for options out of range.
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
    // Returns the same bytes as chunks, named by `start`. The first chunk (S) holds the header and
    // the metadata record. Each further record is one chunk of kind I, or E for the last chunk. The
    // volume must have at most 999 records, because chunk numbers have three digits.
    [[nodiscard]] std::vector<EncodedChunk> chunks() const;
};

struct EncodeOptions {
    int compression_level = 9;     // bzip2 block size, 100 kB units
    int radials_per_record = 120;  // at most; in message 1, at most 100
};

[[nodiscard]] Result<EncodedVolume> encode(const Volume& volume, const EncodeOptions& options = {});

}  // namespace stormcellar::level2

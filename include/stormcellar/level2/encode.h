// stormcellar/level2/encode.h -- Volume -> bytes: the writer.
//
// Writes an Archive II file as the RDA would send it: a 24-byte header, a metadata record of 134
// frames with messages 5 and 2 at their places (the frames of clutter maps and adaptation data stay
// empty, as TDWRs send them: a Volume does not hold them, and they are not made up), then LDM bzip2
// records of up to 120 radials (message 1: 100) that never span two sweeps; the last control word
// is negative. Sweeps of message 31 are written as message 31, those of message 1 as message 1.
//
// decode(encode(v)) gives v to the bit: encode() has the decoder read each record that it makes,
// and refuses a volume of which anything would be lost, rounded, joined or split. Two things the
// bytes do not hold: that a volume had no header (it gets one, AR2V0006.001 or AR2V0001.001 with
// the first radial's time), and the station where there are neither radials of message 31 nor an
// ICAO in the header (the decoder then needs it as its fallback).
//
// Errors  bad_argument for a volume that would not come back; the message names what, with indices
//         from 0. So are numbers between the fields' steps (Nyquist velocity 0.01 m/s, unambiguous
//         range 100 m, thresholds 0.1 and 0.125 dB, a cut's elevation 180/32768 deg), several
//         patterns, codes behind a row's gates, and volumes beyond the limits of decode().
// Memory  a second copy of the volume.
// Source  ICD 2620002W tables II, III, IV, XI, XVII; ICD 2620010 section 7.
// Thread contract: encode() is a pure function.
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
    // The same as chunks: one with the header and the metadata (S), then one a record (I, the last
    // E), named by the volume's start. There must be no more than 999.
    [[nodiscard]] std::vector<EncodedChunk> chunks() const;
};

struct EncodeOptions {
    int compression_level = 9;  // bzip2 block size, 100 kB units
    int radials_per_record = 120;
};

[[nodiscard]] Result<EncodedVolume> encode(const Volume& volume, const EncodeOptions& options = {});

}  // namespace stormcellar::level2

// level2/encode.h -- Volume -> bytes: the writer.
//
// Writes an Archive II file as the RDA would send it: a 24-byte header (AR2V0006), a metadata
// record with messages 15, 13, 18, 3, 5 and 2, then LDM bzip2 records of up to 120 message 31
// radials that never span two sweeps; the last control word is negative. decode(encode(v)) gives
// the same sweeps, codes, geometry, times and VCP to the bit for volumes of message 31.
// Errors: bad_argument for a volume that message 31 cannot hold (no station, no position, more
// than 65,535 gates, rows that do not match).
#pragma once

#include <cstddef>
#include <vector>

#include "base/result.h"
#include "level2/volume.h"

namespace stormcellar::level2 {

// One LDM record: its control word and its bzip2 stream.
struct EncodedRecord {
    std::vector<std::byte> bytes;
};

struct EncodedVolume {
    std::vector<std::byte> header;  // the 24 bytes
    std::vector<EncodedRecord> records;

    [[nodiscard]] std::vector<std::byte> joined() const;  // header and records: a whole file
};

struct EncodeOptions {
    int compression_level = 9;  // bzip2 block size, 100 kB units
    int radials_per_record = 120;
};

[[nodiscard]] Result<EncodedVolume> encode(const Volume& volume, const EncodeOptions& options = {});

}  // namespace stormcellar::level2

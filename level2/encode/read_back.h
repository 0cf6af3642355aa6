// level2/encode/read_back.h -- decodes a volume while it is written and compares the result;
// internal to the writer.
//
// The decoder's own reader reads the messages of each record before they are compressed. The
// decoded volume must equal the written volume to the bit, within the default limits of decode().
//
// Memory    A second copy of the volume.
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "level2/decode/volume_builder.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

class ReadBack {
  public:
    // `volume` must outlive the object.
    explicit ReadBack(const Volume& volume) : volume_(volume) {}

    // Reads the 24-byte header. Errors: bad_argument if the bytes are not recognized as a header,
    // or if the volume has no header and the header made for it does not give the station of the
    // volume.
    [[nodiscard]] Status read_header(std::span<const std::byte> bytes);

    // The reason why the decoder does not accept all of a record.
    struct Fault {
        std::size_t offset = 0;  // of the fault in the messages of the record
        std::string reason;
    };
    // Reads the messages of the next record. Returns none if the decoder reports no problem.
    [[nodiscard]] std::optional<Fault> read_record(std::span<const std::byte> messages);

    // Compares the decoded volume with the written volume after the last record. Errors:
    // bad_argument if they differ; the message names the first difference.
    [[nodiscard]] Status finish();

  private:
    const Volume& volume_;
    VolumeBuilder builder_{DecodeOptions{}.output_limit_bytes};
};

}  // namespace stormcellar::level2

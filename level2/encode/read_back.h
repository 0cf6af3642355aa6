// level2/encode/read_back.h -- what the decoder makes of a volume as it is written; internal to the
// writer.
//
// The decoder's own reader gets the messages of each record before they are compressed, and its
// volume must be the one that is written, to the bit, within the limits that decode() has if nobody
// gives it others.
// Memory: a second copy of the volume.
// Thread contract: one thread.
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
    // `volume` must outlive it.
    explicit ReadBack(const Volume& volume) : volume_(volume) {}

    // The 24 bytes. Errors: bad_argument where they are not taken for a header, or where the one
    // that was made for a volume without a header does not give its station.
    [[nodiscard]] Status read_header(std::span<const std::byte> bytes);

    // Why the decoder does not take all of a record.
    struct Fault {
        std::size_t offset = 0;  // in the record's messages
        std::string reason;
    };
    // The messages of the next record; none where they are read without a problem.
    [[nodiscard]] std::optional<Fault> read_record(std::span<const std::byte> messages);

    // After the last record. Errors: bad_argument where the volume is another, naming the first
    // difference.
    [[nodiscard]] Status finish();

  private:
    const Volume& volume_;
    VolumeBuilder builder_{DecodeOptions{}.output_limit_bytes};
};

}  // namespace stormcellar::level2

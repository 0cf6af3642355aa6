// level2/encode/encode_messages.h -- writes single messages as the RDA sends them; internal to the
// writer.
//
// Every message begins with 12 bytes of communications header, which are zero in archived files,
// and the 16-byte message header (ICD 2620002 table II). Messages in 2432-byte frames are padded to
// the frame; message 31 is as long as its content.
//
// Threads   The functions change only their arguments.
#pragma once

#include <cstddef>
#include <cstdint>

#include "level2/messages/byte_writer.h"
#include "level2/messages/message_header.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Number of frames in the metadata record of every volume; most of them are empty.
inline constexpr std::size_t metadata_frames = 134;

// State that one message of a volume passes on to the next.
struct MessageRun {
    explicit MessageRun(const Volume& volume);

    std::uint16_t sequence = 0;      // number of the next message
    std::size_t pointer_slots = 10;  // number of block pointers for which message 31 has room
};

// Appends the frames of the metadata record. The last frames are message 5, if the volume has a
// VCP, and message 2, if its first sweep is of message 31. The other frames, where the RDA has
// clutter maps and adaptation data, are empty. Errors: bad_argument if the VCP has more cuts than a
// frame holds.
[[nodiscard]] Status append_metadata(ByteWriter& out, const Volume& volume, UtcTime time,
                                     MessageRun& run);

// Starts a message at the end of `out`. Returns the position of its size field, which end_message()
// fills in.
[[nodiscard]] std::size_t begin_message(ByteWriter& out, std::uint8_t channel, std::uint8_t type,
                                        UtcTime time, MessageRun& run);
void end_message(ByteWriter& out, std::size_t size_position);

// Appends radial `index` of a sweep as a frame of message 1. The sweep must be consistent
// (encode_checks.h). Errors: bad_argument if the frame cannot hold the gates. Numbers that do not
// fit their fields are cut; ReadBack finds them.
[[nodiscard]] Status append_radial_1(ByteWriter& out, const Volume& volume, const Sweep& sweep,
                                     std::size_t index, MessageRun& run);

// Appends radial `index` of a sweep as message 31. The sweep must be consistent (encode_checks.h).
// Errors: bad_argument if the radial is larger than its 16-bit length allows.
[[nodiscard]] Status append_radial(ByteWriter& out, const Volume& volume, const Sweep& sweep,
                                   std::size_t index, MessageRun& run);

}  // namespace stormcellar::level2

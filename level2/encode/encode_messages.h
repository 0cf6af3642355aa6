// level2/encode/encode_messages.h -- writes single messages as the RDA sends them; internal to the
// writer.
//
// Every message begins with 12 bytes of communications header, which are zero in archived files,
// and the 16-byte message header (ICD 2620002 table II). Messages in 2432-byte frames are padded to
// the frame; message 31 is as long as its content.
//
// Threads   Functions that change only their arguments.
#pragma once

#include <cstddef>
#include <cstdint>

#include "level2/messages/byte_writer.h"
#include "level2/messages/message_header.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// The metadata record of a volume always holds this many frames, most of them empty.
inline constexpr std::size_t metadata_frames = 134;

// The state that continues from message to message of one volume.
struct MessageRun {
    explicit MessageRun(const Volume& volume);

    std::uint16_t sequence = 0;      // number of the next message
    std::size_t pointer_slots = 10;  // number of block pointers for which message 31 has room
};

// Appends the frames of the metadata record: empty ones where the RDA has clutter maps and
// adaptation data, and message 5 (if the volume has a VCP) and message 2 at the places where the
// RDA puts them. Errors: bad_argument if the VCP has more cuts than a frame holds.
[[nodiscard]] Status append_metadata(ByteWriter& out, const Volume& volume, UtcTime time,
                                     MessageRun& run);

// Starts a message at the end of `out` and returns the place of its size, which end_message() fills
// in.
[[nodiscard]] std::size_t begin_message(ByteWriter& out, std::uint8_t channel, std::uint8_t type,
                                        UtcTime time, MessageRun& run);
void end_message(ByteWriter& out, std::size_t size_position);

// Appends radial `index` of a sweep as a frame of message 1. The sweep must be consistent. Errors:
// bad_argument if the frame cannot hold its gates. Numbers that do not fit their fields are cut;
// read_back.h detects them.
[[nodiscard]] Status append_radial_1(ByteWriter& out, const Volume& volume, const Sweep& sweep,
                                     std::size_t index, MessageRun& run);

// Appends radial `index` of a sweep as message 31. The sweep must be consistent (encode_checks.h).
// Errors: bad_argument if the radial is larger than its 16-bit length allows.
[[nodiscard]] Status append_radial(ByteWriter& out, const Volume& volume, const Sweep& sweep,
                                   std::size_t index, MessageRun& run);

}  // namespace stormcellar::level2

// level2/encode/encode_messages.h -- single messages as the RDA sends them; used by the writer
// only.
//
// Every message begins with 12 bytes of communications header, which are zero in archived files,
// and the 16-byte message header (ICD 2620002 table II). Messages of 2432-byte frames are padded to
// the frame; message 31 is as long as its content.
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

// What runs on from message to message of one volume.
struct MessageRun {
    explicit MessageRun(const Volume& volume);

    std::uint16_t sequence = 0;      // the next message's number
    std::size_t pointer_slots = 10;  // block pointers that message 31 has room for
};

// Appends the frames of the metadata record: empty ones where the RDA has clutter maps and
// adaptation data, message 5 (when the volume has a VCP) and message 2 in the places where the RDA
// puts them.
// Errors: bad_argument when the VCP has more cuts than a frame holds.
[[nodiscard]] Status append_metadata(ByteWriter& out, const Volume& volume, UtcTime time,
                                     MessageRun& run);

// Starts a message at the end of `out` and gives the position of its size; end_message() fills that
// in.
[[nodiscard]] std::size_t begin_message(ByteWriter& out, std::uint8_t channel, std::uint8_t type,
                                        UtcTime time, MessageRun& run);
void end_message(ByteWriter& out, std::size_t size_position);

// Appends radial `index` of a sweep as a frame of message 1. The sweep must be consistent.
// Errors: bad_argument when the frame cannot hold its gates. Numbers beyond their fields are cut:
// read_back.h finds them.
[[nodiscard]] Status append_radial_1(ByteWriter& out, const Volume& volume, const Sweep& sweep,
                                     std::size_t index, MessageRun& run);

// Appends radial `index` of a sweep as message 31. The sweep must be consistent (see
// encode_checks). Errors: bad_argument when the radial is larger than its 16-bit length allows.
[[nodiscard]] Status append_radial(ByteWriter& out, const Volume& volume, const Sweep& sweep,
                                   std::size_t index, MessageRun& run);

}  // namespace stormcellar::level2
